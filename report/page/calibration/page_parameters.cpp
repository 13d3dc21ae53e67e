#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "common/significant.hpp"
#include "metrics/distributions.hpp"
#include "report/document/quantity.hpp"
#include "report/document/words.hpp"
#include "report/page/calibration/assessed.hpp"
#include "report/page/calibration/fit_sections.hpp"
#include "report/page/page_parts.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

using doc::Line;
using Kind = doc::Column::Kind;

Range bounds_of(const calib::FittedParameter& p) {
  return {p.lower.value_or(kAnywhere.low), p.upper.value_or(kAnywhere.high)};
}

/// Returns a cell with a standard error and the 95 % interval based only on this error, assuming a
/// normal distribution.
doc::Cell error_cell(const calib::FittedParameter& p, const std::optional<double>& error,
                     const ReadableUnit& unit) {
  doc::Cell cell{Line{doc::in_unit(error, unit.si, kErrorDigits)}};
  if (!std::isfinite(p.value) || !error) return cell;
  const Range range{p.value - metrics::kNormal95 * *error, p.value + metrics::kNormal95 * *error};
  cell.below = {doc::estimate(p.value, range, unit.si, bounds_of(p)).interval()};
  return cell;
}

/// @param judged  whether the search converged
/// @param reason  a reason that applies only to this estimate
doc::Row fitted_row(const calib::FittedParameter& p, bool judged, const std::string& reason) {
  const ReadableUnit unit = unit_of(p);
  const doc::Estimate estimate = doc::estimate(p.value, p.ci95, unit.si, bounds_of(p));
  Line name{p.key, " ", doc::Symbol{p.symbol}};
  if (p.nuisance) name.emplace_back(doc::Soft{" nuisance"});
  const double half_width = relative_half_width(p);
  doc::Cell interval{estimate.interval()};
  if (!std::isinf(half_width)) interval.below = {{half_width_text(half_width)}};
  if (p.budget) {
    Line exact{"if exact "};
    for (doc::Inline& part :
         doc::estimate(p.value, p.ci95_if_exact, unit.si, bounds_of(p)).interval())
      exact.push_back(std::move(part));
    interval.below.push_back(std::move(exact));
  }
  doc::Cell start{Line{doc::in_unit(p.start, unit.si, 5)}};
  start.below = {{doc::in_unit(p.lower, unit.si, 4), " … ", doc::in_unit(p.upper, unit.si, 4)}};
  doc::Row row{{{std::move(name)},
                p.level.value_or("rig"),
                estimate.value,
                unit.name,
                std::move(interval),
                doc::badge(p.identifiability, p.at_bound, judged),
                error_cell(p, p.standard_error, unit),
                error_cell(p, p.robust_standard_error, unit),
                std::move(start)}};
  if (!reason.empty()) row.notes = {reason};
  return row;
}

doc::Row known_row(const calib::FittedParameter& p) {
  const ReadableUnit unit = unit_of(p);
  return {{Line{p.key, " ", doc::Symbol{p.symbol}}, p.level.value_or("rig"),
           doc::in_unit(p.value, unit.si, 6), unit.name, p.reason}};
}

doc::Table correlation_table(const calib::Correlation& correlation) {
  const std::vector<std::string>& names = correlation.names;
  doc::Table table{"Correlation of the estimates"};
  table.style = "correlation";
  table.columns = {{"Parameter"}};
  for (std::size_t i = 0; i < names.size(); ++i)
    table.columns.push_back({fmt::format("{}", i + 1), Kind::number});
  for (std::size_t i = 0; i < names.size(); ++i) {
    doc::Row row{{fmt::format("{} {}", i + 1, names[i])}};
    for (std::size_t j = 0; j < names.size(); ++j) {
      const double r = correlation_at(correlation, i, j);
      doc::Cell cell{Line{doc::decimals(r, 2)}};
      if (i != j && !std::isnan(r)) cell.shade = r;
      row.cells.push_back(std::move(cell));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::vector<std::string> parts_of_reason(const std::string& reason) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin < reason.size();) {
    const std::size_t end = std::min(reason.find("; ", begin), reason.size());
    parts.push_back(reason.substr(begin, end - begin));
    begin = end + 2;
  }
  return parts;
}

std::string joined_reason(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : "; ") + part;
  return text;
}

/// Returns the reasons that all estimates have in common, so that they are shown only once.
std::vector<std::string> common_reasons(const std::vector<const calib::FittedParameter*>& fitted) {
  std::vector<std::string> common;
  if (fitted.size() < 2) return common;
  for (const std::string& part : parts_of_reason(fitted.front()->reason)) {
    const bool everywhere =
        std::all_of(fitted.begin(), fitted.end(), [&](const calib::FittedParameter* p) {
          const auto parts = parts_of_reason(p->reason);
          return std::find(parts.begin(), parts.end(), part) != parts.end();
        });
    if (everywhere) common.push_back(part);
  }
  return common;
}

/// Returns the reason for one estimate, without the reasons that it shares with all others.
std::string own_reason(const calib::FittedParameter& p, const std::vector<std::string>& common) {
  auto parts = parts_of_reason(p.reason);
  std::erase_if(parts, [&](const std::string& part) {
    return std::find(common.begin(), common.end(), part) != common.end();
  });
  return joined_reason(parts);
}

std::vector<std::string> not_identifiable(const StoredFit& fit) {
  std::vector<std::string> names;
  for (const calib::FittedParameter& p : fit.parameters) {
    if (p.fitted && p.identifiability == calib::Identifiability::not_identifiable)
      names.push_back(parameter_label(p));
  }
  return names;
}

}  // namespace

double relative_half_width(const calib::FittedParameter& parameter) {
  const auto ends = Interval(parameter.ci95).ends;
  const double value = parameter.value;
  if (!ends || !std::isfinite(value) || value == 0.0) return HUGE_VAL;
  return std::max(ends->high - value, value - ends->low) / std::abs(value);
}

bool is_determined(double relative_half_width) {
  constexpr double kMeaningless = 10.0;
  return relative_half_width <= kMeaningless;
}

std::string half_width_text(double relative) {
  if (!is_determined(relative)) return "not determined";
  return fmt::format("± {} %", significant(100.0 * relative, kErrorDigits));
}

doc::Section parameters_section(const std::vector<calib::FittedParameter>& parameters,
                                const calib::Correlation& correlation, bool judged) {
  doc::Section section{"parameters", "Parameters"};
  if (!judged)
    section.blocks.emplace_back(
        doc::Paragraph{{"Stopped before it converged: the values are the best so far. Standard "
                        "errors and intervals assume a minimum and are not valid here."},
                       doc::Paragraph::Tone::problem});
  std::vector<const calib::FittedParameter*> estimated;
  doc::Table known{"Known values"};
  known.columns = {{"Parameter"}, {"For"}, {"Value", Kind::number}, {"Unit"}, {"Note"}};
  for (const calib::FittedParameter& p : parameters) {
    if (p.fitted) {
      estimated.push_back(&p);
    } else {
      known.rows.push_back(known_row(p));
    }
  }
  if (estimated.empty()) {
    section.blocks.emplace_back(doc::reading("Nothing was estimated."));
  } else {
    doc::Table table{"Estimated parameters"};
    table.caption = {"Estimated, with 95 % intervals"};
    table.shape = doc::Table::Shape::cards;
    table.style = "parameters";
    table.columns = {{"Parameter"},
                     {"For"},
                     {"Value", Kind::number},
                     {"Unit", Kind::unit},
                     {"95 % interval", Kind::number, 0, "half width"},
                     {"Identified?"},
                     {"Plain std. error", Kind::number, 0, "its interval"},
                     {"Robust std. error", Kind::number, 0, "its interval"},
                     {"Start", Kind::number, 0, "bounds"}};
    const std::vector<std::string> common = common_reasons(estimated);
    for (const calib::FittedParameter* p : estimated)
      table.rows.push_back(fitted_row(*p, judged, own_reason(*p, common)));
    section.blocks.emplace_back(std::move(table));
    if (!common.empty())
      section.blocks.emplace_back(doc::reading("All: " + joined_reason(common) + "."));
    add_budget(parameters, section.blocks);
  }
  if (correlation.names.size() > 1) {
    section.blocks.emplace_back(doc::Heading{{"Correlation of the estimates"}});
    section.blocks.emplace_back(doc::reading(correlation_words(correlation)));
    section.blocks.emplace_back(correlation_table(correlation));
  }
  if (!known.rows.empty()) {
    const std::string summary = fmt::format("Known values ({})", known.rows.size());
    section.blocks.emplace_back(doc::Fold{summary, {std::move(known)}});
  }
  return section;
}

/// Adds the singular values of the Jacobian with an explanation.
void add_singular_values(const StoredFit& fit, doc::Blocks& blocks) {
  std::vector<double> values = fit.singular_values;
  std::erase_if(values, [](double value) { return std::isnan(value); });
  if (values.empty()) {
    blocks.emplace_back(doc::reading("No parameter was estimated."));
    return;
  }
  const int rank = fit.rank;
  const auto all = static_cast<int>(values.size());
  if (rank < all) {
    blocks.emplace_back(
        doc::reading(fmt::format("The Jacobian has rank {} of {}: {} combination{} of the "
                                 "parameters can change without any effect on the records.",
                                 rank, all, all - rank, all - rank == 1 ? "" : "s")));
  } else {
    const std::vector<std::string> open = not_identifiable(fit);
    blocks.emplace_back(doc::reading(fmt::format(
        "The Jacobian has full rank ({} of {}): every combination of the parameters affects the "
        "records; the strongest effect is {:.3g} times the weakest. {}",
        rank, all, values.back() > 0.0 ? values.front() / values.back() : 0.0,
        open.empty() ? "No parameter is graded not identifiable."
                     : fmt::format("The effect is too small relative to the noise to identify {}.",
                                   fmt::join(open, ", ")))));
  }
  blocks.emplace_back(doc::Figure{[values] {
                                    Plot plot =
                                        ranked_points("Singular values of the scaled Jacobian",
                                                      "singular value", values);
                                    plot.x_label = "direction";
                                    return plot;
                                  },
                                  "", true});
  Line list{"Singular values: "};
  for (const double value : values) {
    if (list.size() > 1) list.emplace_back(", ");
    list.emplace_back(doc::in_unit(value, 1.0, 4));
  }
  list.emplace_back(".");
  blocks.emplace_back(doc::Paragraph{std::move(list), doc::Paragraph::Tone::source});
}

}  // namespace rigcal::report
