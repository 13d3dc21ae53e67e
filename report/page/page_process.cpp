#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/page/page_parts.hpp"

namespace rigcal::report {

Json starts_view(const Json& result) {
  Json view;
  const Json& starts = result.at("starts");
  view["known"] = !starts.empty();
  view["rows"] = Json::array();
  const int best = result.at("best_start").get<int>();
  std::vector<double> costs;
  double least = HUGE_VAL;
  for (const Json& start : starts) {
    const auto final_cost = number_of(start, "final_cost");
    const int number = start.at("number").get<int>();
    view["rows"].push_back({{"number", fmt::format("{}", number)},
                            {"best", number == best},
                            {"status", text_of(start, "status")},
                            {"initial_cost", shown_in(start.at("initial_cost"), 1.0, 6)},
                            {"final_cost", shown_in(start.at("final_cost"), 1.0, 6)},
                            {"iterations", fmt::format("{}", start.at("iterations").get<int>())},
                            {"message", text_of(start, "message")}});
    if (!final_cost || text_of(start, "status") == "failed") continue;
    costs.push_back(*final_cost);
    least = std::min(least, *final_cost);
  }
  std::sort(costs.begin(), costs.end());
  const std::size_t all = starts.size();
  view["count"] = fmt::format("{}", all);
  view["few"] = all <= kFew;
  if (costs.empty()) {
    view["reading"] = "No start ended with a cost: there is no answer.";
  } else if (all == 1) {
    view["reading"] = "One start alone: whether another minimum lies lower was not looked for.";
  } else {
    view["reading"] = text_of(result, "agreement") + ".";
  }
  const auto cost = number_of(result, "cost");
  constexpr double kSameCost = 1e-3;
  if (cost && !costs.empty() && std::abs(*cost - least) > kSameCost * least) {
    view["reading"] = fmt::format(
        "{} These costs are by the noise as it was taken before the last estimate of it; by that "
        "of the result the cost is {:.6g}.",
        text_of(view, "reading"), *cost);
  }
  view["waterfall"] = costs.size() > 1;
  if (costs.size() > 1) {
    Plot plot = ranked_points("Cost of every start, sorted", "final cost", costs);
    plot.x_label = "start, best first";
    view["plot_html"] = svg(plot);
  }
  return view;
}

Json ledger_view(const Json& result) {
  Json view;
  view["warnings"] = Json::array();
  for (const Json& warning : result.at("warnings")) view["warnings"].push_back({{"text", warning}});
  view["has_warnings"] = !view["warnings"].empty();
  view["warning_count"] = fmt::format("{}", view["warnings"].size());
  view["few_warnings"] = view["warnings"].size() <= kFew;
  view["failures"] = Json::array();
  for (const Json& failure : result.at("failures")) {
    std::string values;
    for (const auto& [name, value] : failure.at("parameters").items()) {
      values += fmt::format("{}{} = {}", values.empty() ? "" : ", ", name,
                            value.is_number() ? fmt::format("{:.6g}", value.get<double>()) : "–");
    }
    view["failures"].push_back({{"condition", text_of(failure, "condition")},
                                {"start", fmt::format("{}", failure.at("start").get<int>())},
                                {"time", shown(failure.at("time_s"), "s", 5)},
                                {"reason", text_of(failure, "reason")},
                                {"values", values}});
  }
  view["has_failures"] = !view["failures"].empty();
  view["failure_count"] = fmt::format("{}", result.at("failure_count").get<long>());
  view["nothing"] = view["warnings"].empty() && view["failures"].empty();
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

void add_making(const Json& result, Json& view) {
  const auto add = [&](const char* fact, const char* key, int digits, const char* unit) {
    if (const auto value = number_of(result, key)) {
      view["facts"].push_back(
          {{"name", fact}, {"value", fmt::format("{:.{}g}{}", *value, digits, unit)}});
    }
  };
  add("Tolerance of the simulations", "simulation_tolerance", 3, "");
  add("Residuals", "residual_count", 12, "");
  add("Evaluations", "evaluations", 12, "");
  add("Time", "wall_seconds", 3, " s");
  add("Cost", "cost", 8, "");
  add("Reduced chi-square", "reduced_chi_square", 5, "");
}

}  // namespace rigcal::report
