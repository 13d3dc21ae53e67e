#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "report/document/quantity.hpp"
#include "report/page/calibration/fit_sections.hpp"
#include "report/page/page_parts.hpp"

namespace rigcal::report {
namespace {

using doc::Line;
using Kind = doc::Column::Kind;

doc::Table start_table(const StoredFit& fit) {
  doc::Table table{"Starts"};
  table.columns = {{"Start", Kind::number},         {"Status"},
                   {"Cost at start", Kind::number}, {"Cost at end", Kind::number},
                   {"Iterations", Kind::number},    {"Why it ended", Kind::words}};
  for (const calib::StartReport& start : fit.starts) {
    const bool best = start.number == fit.best_start;
    table.rows.push_back(
        {{fmt::format("{}{}", start.number, best ? " ★ best" : ""),
          std::string(to_string(start.status)), doc::in_unit(finite(start.initial_cost), 1.0, 6),
          doc::in_unit(finite(start.final_cost), 1.0, 6), fmt::format("{}", start.iterations),
          start.message}});
  }
  return table;
}

/// Explains the further starts of a fit for which one start was requested.
std::string further_starts_of(const StoredFit& fit) {
  if (fit.assessment) {
    for (const calib::Reason& reason : fit.assessment->parameters.reasons) {
      if (reason.code == "further_starts") return reason.words + ".";
    }
  }
  return "Only one start: no search for a lower minimum was made.";
}

/// Summarises all starts.
///
/// @param costs  final costs of the starts, sorted
std::string start_reading(const StoredFit& fit, const std::vector<double>& costs) {
  if (costs.empty()) return "No start could be evaluated: there is no result.";
  std::string text =
      fit.starts.size() == 1 ? further_starts_of(fit) : std::string(fit.agreement) + ".";
  if (fit.starts.size() == 1 && !fit.agreement.empty())
    text += " " + capitalised(fit.agreement) + ".";
  constexpr double kSameCost = 1e-3;
  if (fit.cost && std::abs(*fit.cost - costs.front()) > kSameCost * costs.front()) {
    text += fmt::format(
        " These costs use the noise estimate before the last update; with the final estimate the "
        "cost is {:.6g}.",
        *fit.cost);
  }
  return text;
}

}  // namespace

doc::Section starts_section(const StoredFit& fit) {
  doc::Section section{"starts", "Starts"};
  doc::Blocks& blocks = section.blocks;
  if (fit.starts.empty()) {
    blocks.emplace_back(doc::reading("No start was made, because nothing was estimated."));
    return section;
  }
  std::vector<double> costs;
  for (const calib::StartReport& start : fit.starts) {
    if (std::isfinite(start.final_cost) && start.status != calib::FitStatus::failed)
      costs.push_back(start.final_cost);
  }
  std::sort(costs.begin(), costs.end());
  blocks.emplace_back(doc::reading(start_reading(fit, costs)));
  if (costs.size() > 1) {
    blocks.emplace_back(doc::Figure{[costs] {
                                      Plot plot = ranked_points("Cost of every start, sorted",
                                                                "final cost", costs);
                                      plot.x_label = "start, best first";
                                      return plot;
                                    },
                                    "", true});
  }
  doc::Fold all{fmt::format("Every start ({})", fit.starts.size()), {start_table(fit)}};
  all.open = fit.starts.size() <= kFew;
  blocks.emplace_back(std::move(all));
  if (fit.basins.size() < 2) return section;
  doc::Table basins{"Where converged starts ended"};
  basins.caption = {basins.label};
  basins.columns = {{"Cost", Kind::number}, {"Starts", Kind::number}};
  for (const calib::Basin& basin : fit.basins)
    basins.rows.push_back(
        {{doc::in_unit(basin.cost, 1.0, 8), fmt::format("{}", basin.starts.size())}});
  blocks.emplace_back(std::move(basins));
  return section;
}

std::vector<std::string> warnings_to_show(const StoredFit& fit) {
  std::vector<std::string> warnings;
  for (const std::string& warning : fit.warnings) {
    // The parameter table already shows this reason.
    const bool is_shown = std::any_of(
        fit.parameters.begin(), fit.parameters.end(), [&](const calib::FittedParameter& p) {
          return p.fitted && !p.reason.empty() && warning.ends_with(": " + p.reason);
        });
    if (!is_shown) warnings.push_back(warning);
  }
  return warnings;
}

doc::Section warnings_section(const StoredFit& fit) {
  doc::Section section{"warnings", "Failures and warnings"};
  doc::List warnings{{}, doc::State::warn};
  for (std::string& warning : warnings_to_show(fit)) warnings.items.push_back({std::move(warning)});
  if (warnings.items.empty() && fit.failures.empty())
    section.blocks.emplace_back(doc::reading("None."));
  else
    section.always = true;
  if (!warnings.items.empty()) {
    doc::Fold fold{fmt::format("Warnings ({})", warnings.items.size()), {}};
    fold.open = warnings.items.size() <= kFew;
    fold.blocks = {std::move(warnings)};
    section.blocks.emplace_back(std::move(fold));
  }
  if (fit.failures.empty()) return section;
  doc::Table table{"Failed simulations"};
  table.caption = {fmt::format("{} simulations failed during the search; the first of each kind",
                               fit.failure_count)};
  table.columns = {{"Condition"},
                   {"Start", Kind::number},
                   {"At", Kind::number},
                   {"Why", Kind::words},
                   {"Values", Kind::words}};
  for (const calib::SimulationFailure& failure : fit.failures) {
    std::string values;
    for (const auto& [name, value] : failure.parameters) {
      values += fmt::format("{}{} = {}", values.empty() ? "" : ", ", name,
                            std::isnan(value) ? "–" : fmt::format("{:.6g}", value));
    }
    table.rows.push_back({{failure.condition, fmt::format("{}", failure.start),
                           doc::readable(failure.time_s, "s", 5), failure.reason, values}});
  }
  section.blocks.emplace_back(std::move(table));
  return section;
}

std::string program_of(const StoredProvenance& provenance) {
  return fmt::format("rigcal {} ({})", provenance.version, provenance.revision.substr(0, 7));
}

doc::Blocks provenance_blocks(const StoredProvenance& provenance, const std::string& name,
                              const std::string& file, const doc::Facts& making) {
  doc::Facts facts{"Provenance of " + name};
  const auto add = [&](const std::string& fact, const std::string& value) {
    if (!value.empty()) facts.rows.push_back({fact, {value}});
  };
  add("Program", fmt::format("rigcal {}", provenance.version));
  add("Git revision", provenance.revision);
  add("Machine", provenance.machine);
  add("Seed", fmt::format("{}", provenance.seed));
  for (const auto& [option, value] : provenance.options) add("Option " + option, value);
  facts.rows.insert(facts.rows.end(), making.rows.begin(), making.rows.end());
  return {doc::Heading{{name}}, doc::Command{provenance.command}, std::move(facts),
          doc::Paragraph{
              {fmt::format("Drawn from {} and the files in its folder; ", file),
               doc::Code{"rigcal report"}, " reproduces the page from that folder, byte for byte."},
              doc::Paragraph::Tone::source}};
}

namespace {

void add_fact(doc::Facts& facts, const char* fact, const std::optional<double>& value, int digits,
              const char* unit = "") {
  if (value) facts.rows.push_back({fact, {fmt::format("{:.{}g}{}", *value, digits, unit)}});
}

/// Adds the facts that fits to records and fits to published tables have in common.
template <typename Fit>
void add_effort(const Fit& fit, doc::Facts& facts) {
  add_fact(facts, "Residuals", static_cast<double>(fit.residual_count), 12);
  add_fact(facts, "Evaluations", static_cast<double>(fit.evaluations), 12);
  add_fact(facts, "Time", fit.wall_seconds, 3, " s");
  add_fact(facts, "Cost", fit.cost, 8);
}

}  // namespace

doc::Facts making_of(const StoredFit& fit) {
  doc::Facts facts;
  add_fact(facts, "Tolerance of the simulations", fit.simulation_tolerance, 3);
  add_effort(fit, facts);
  add_fact(facts, "Reduced chi-square", fit.reduced_chi_square, 5);
  return facts;
}

doc::Facts making_of(const StoredTablesFit& fit) {
  doc::Facts facts;
  add_effort(fit, facts);
  return facts;
}

}  // namespace rigcal::report
