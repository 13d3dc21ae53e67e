#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/page/page_parts.hpp"

namespace rigcal::report {
namespace {

/// What a fit of one start says of further ones.
std::string further_starts_of(const StoredFit& fit) {
  if (fit.assessment) {
    for (const StoredReason& reason : fit.assessment->parameters.reasons) {
      if (reason.code == "further_starts") return reason.words + ".";
    }
  }
  return "One start alone: whether another minimum lies lower was not looked for.";
}

}  // namespace

Json starts_view(const StoredFit& fit) {
  Json view;
  view["known"] = !fit.starts.empty();
  view["rows"] = Json::array();
  std::vector<double> costs;
  double least = HUGE_VAL;
  for (const StoredStart& start : fit.starts) {
    view["rows"].push_back({{"number", fmt::format("{}", start.number)},
                            {"best", start.number == fit.best_start},
                            {"status", to_string(start.status)},
                            {"initial_cost", shown_in(start.initial_cost, 1.0, 6)},
                            {"final_cost", shown_in(start.final_cost, 1.0, 6)},
                            {"iterations", fmt::format("{}", start.iterations)},
                            {"message", start.message}});
    if (!start.final_cost || start.status == calib::FitStatus::failed) continue;
    costs.push_back(*start.final_cost);
    least = std::min(least, *start.final_cost);
  }
  std::sort(costs.begin(), costs.end());
  view["count"] = fmt::format("{}", fit.starts.size());
  view["few"] = fit.starts.size() <= kFew;
  if (costs.empty()) {
    view["reading"] = "No start ended with a cost: there is no answer.";
  } else if (fit.starts.size() == 1) {
    view["reading"] = further_starts_of(fit);
  } else {
    view["reading"] = fit.agreement + ".";
  }
  constexpr double kSameCost = 1e-3;
  if (fit.cost && !costs.empty() && std::abs(*fit.cost - least) > kSameCost * least) {
    view["reading"] = fmt::format(
        "{} These costs are by the noise as it was taken before the last estimate of it; by that "
        "of the result the cost is {:.6g}.",
        text_of(view, "reading"), *fit.cost);
  }
  view["waterfall"] = costs.size() > 1;
  if (costs.size() > 1) {
    Plot plot = ranked_points("Cost of every start, sorted", "final cost", costs);
    plot.x_label = "start, best first";
    view["plot_html"] = svg(plot);
  }
  return view;
}

Json ledger_view(const StoredFit& fit) {
  Json view;
  view["warnings"] = Json::array();
  for (const std::string& warning : fit.warnings) {
    // Beside its parameter it was told already.
    const bool told =
        std::any_of(fit.parameters.begin(), fit.parameters.end(), [&](const StoredParameter& p) {
          return p.fitted && !p.reason.empty() && warning.ends_with(": " + p.reason);
        });
    if (!told) view["warnings"].push_back({{"text", warning}});
  }
  const std::size_t count = view["warnings"].size();
  view["has_warnings"] = count > 0;
  view["warning_count"] = fmt::format("{}", count);
  view["few_warnings"] = count <= kFew;
  view["failures"] = Json::array();
  for (const StoredFailure& failure : fit.failures) {
    std::string values;
    for (const auto& [name, value] : failure.parameters) {
      values += fmt::format("{}{} = {}", values.empty() ? "" : ", ", name,
                            std::isnan(value) ? "–" : fmt::format("{:.6g}", value));
    }
    view["failures"].push_back({{"condition", failure.condition},
                                {"start", fmt::format("{}", failure.start)},
                                {"time", shown(failure.time_s, "s", 5)},
                                {"reason", failure.reason},
                                {"values", values}});
  }
  view["has_failures"] = !fit.failures.empty();
  view["failure_count"] = fmt::format("{}", fit.failure_count);
  view["nothing"] = count == 0 && fit.failures.empty();
  return view;
}

Json provenance_view(const StoredProvenance& provenance, const std::string& name,
                     const std::string& file) {
  Json view;
  view["name"] = name;
  view["file"] = file;
  view["command"] = provenance.command;
  view["facts"] = Json::array();
  const auto add = [&](const std::string& fact, const std::string& value) {
    if (!value.empty()) view["facts"].push_back({{"name", fact}, {"value", value}});
  };
  add("Program", fmt::format("rigcal {}", provenance.version));
  add("Git revision", provenance.revision);
  add("Machine", provenance.machine);
  add("Seed", fmt::format("{}", provenance.seed));
  for (const auto& [option, value] : provenance.options) add("Option " + option, value);
  view["inputs"] = json_of(provenance.inputs);
  const std::size_t count = provenance.inputs.size();
  view["input_count"] = fmt::format("{} input file{}", count, count == 1 ? "" : "s");
  return view;
}

namespace {

void add_fact(Json& view, const char* fact, const std::optional<double>& value, int digits,
              const char* unit = "") {
  if (!value) return;
  view["facts"].push_back(
      {{"name", fact}, {"value", fmt::format("{:.{}g}{}", *value, digits, unit)}});
}

/// What a fit to records and one to published tables both tell.
template <typename Fit>
void add_effort(const Fit& fit, Json& view) {
  add_fact(view, "Residuals", static_cast<double>(fit.residual_count), 12);
  add_fact(view, "Evaluations", static_cast<double>(fit.evaluations), 12);
  add_fact(view, "Time", fit.wall_seconds, 3, " s");
  add_fact(view, "Cost", fit.cost, 8);
}

}  // namespace

void add_making(const StoredFit& fit, Json& view) {
  add_fact(view, "Tolerance of the simulations", fit.simulation_tolerance, 3);
  add_effort(fit, view);
  add_fact(view, "Reduced chi-square", fit.reduced_chi_square, 5);
}

void add_making(const StoredTablesFit& fit, Json& view) { add_effort(fit, view); }

}  // namespace rigcal::report
