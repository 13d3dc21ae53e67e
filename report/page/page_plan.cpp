#include "report/page/page_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rigcal::report {
namespace {

/// A standard deviation in percent of the value; a dash where there is none.
std::string percent_text(const std::optional<double>& sd, const std::optional<double>& value) {
  if (!sd || !value || *value == 0.0) return "–";
  const double percent = 100.0 * *sd / std::abs(*value);
  return percent > 1000.0 ? std::string("> 1000") : fmt::format("{:.3g}", percent);
}

Json percent_row(const StoredPlan& plan, const std::string& label,
                 const std::vector<std::optional<double>>& sd) {
  Json cells = Json::array();
  for (std::size_t j = 0; j < plan.parameters.size(); ++j)
    cells.push_back(percent_text(sd[j], plan.parameters[j].value));
  return {{"label", label}, {"cells", std::move(cells)}};
}

std::vector<std::optional<double>> of_all(const StoredPlan& plan,
                                          std::optional<double> StoredPlannedParameter::*sd) {
  std::vector<std::optional<double>> list;
  for (const StoredPlannedParameter& parameter : plan.parameters) list.push_back(parameter.*sd);
  return list;
}

Trace bar(double at, double height, const std::string& style) {
  Trace trace = empty_trace(Trace::Kind::band, style);
  constexpr double kHalfWidth = 0.35;
  trace.x = {at - kHalfWidth, at + kHalfWidth};
  trace.y = {0.0, 0.0};
  trace.upper = {height, height};
  return trace;
}

}  // namespace

std::vector<Figure> plan_figures(const StoredPlan& plan) {
  std::vector<Figure> figures;
  for (std::size_t j = 0; j < plan.parameters.size(); ++j) {
    const StoredPlannedParameter& parameter = plan.parameters[j];
    const std::optional<double>& all = parameter.sd_all;
    if (!all || !(*all > 0.0)) continue;
    Plot plot;
    plot.title = fmt::format("{}: share of the precision of all records that each has alone",
                             parameter.label());
    plot.x_label = "record";
    plot.y_label = fmt::format("{} [%]", parameter.label());
    plot.width = 300.0;
    plot.height = 150.0;
    plot.whole_x = true;
    plot.levels = {0.0};
    for (std::size_t i = 0; i < plan.records.size(); ++i) {
      const auto& alone = plan.records[i].sd_alone[j];
      const double share = alone && *alone > 0.0 ? std::pow(*all / *alone, 2) : 0.0;
      plot.traces.push_back(bar(static_cast<double>(i + 1), 100.0 * share,
                                plan.records[i].recorded ? "residual" : "model"));
    }
    figures.push_back({"plan_" + plain_name(parameter.label()), std::move(plot)});
  }
  return figures;
}

Json plan_headline(const StoredPlan& plan) {
  const auto recorded = std::count_if(plan.records.begin(), plan.records.end(),
                                      [](const auto& record) { return record.recorded; });
  const auto told =
      std::count_if(plan.parameters.begin(), plan.parameters.end(),
                    [](const auto& parameter) { return parameter.sd_all.has_value(); });
  const bool whole = static_cast<std::size_t>(told) == plan.parameters.size();
  Json view = make_headline(
      "PLAN", whole ? "✓" : "!", whole ? "good" : "warn",
      fmt::format("{} of {} records exist; all together determine {} of {} parameters.", recorded,
                  plan.records.size(), told, plan.parameters.size()));
  for (const StoredPlannedParameter& parameter : plan.parameters) {
    if (parameter.sd_all) continue;
    add_reason(view,
               fmt::format("{} is not determined{}{}", parameter.label(),
                           parameter.remedy ? ": " : "", parameter.remedy.value_or("")),
               "plan");
  }
  for (const std::string& message : plan.messages) add_reason(view, message, "plan");
  return view;
}

Json plan_view(const StoredPlan& plan) {
  Json view;
  view["parameters"] = Json::array();
  view["totals"] = Json::array();
  for (const StoredPlannedParameter& parameter : plan.parameters) {
    const RowUnit unit = row_unit(parameter.value.value_or(0.0), parameter.unit);
    view["parameters"].push_back({{"name", parameter.label()}});
    view["totals"].push_back({{"name", parameter.label()},
                              {"unit", unit.name.empty() ? std::string("1") : unit.name},
                              {"value", shown_in(parameter.value, unit.si, 5)},
                              {"recorded", shown_in(parameter.sd_recorded, unit.si, 2)},
                              {"all", shown_in(parameter.sd_all, unit.si, 2)},
                              {"remedy", parameter.remedy.value_or("")}});
  }
  view["alone"] = Json::array();
  view["without"] = Json::array();
  view["problems"] = Json::array();
  for (std::size_t i = 0; i < plan.records.size(); ++i) {
    const StoredPlannedRecord& record = plan.records[i];
    const std::string label =
        fmt::format("{} {}{}", i + 1, record.condition, record.recorded ? "" : " (planned)");
    view["alone"].push_back(percent_row(plan, label, record.sd_alone));
    view["without"].push_back(percent_row(plan, label, record.sd_without));
    if (record.problem)
      view["problems"].push_back(fmt::format("{}: {}", record.condition, *record.problem));
  }
  view["alone"].push_back(percent_row(plan, "All that are recorded",
                                      of_all(plan, &StoredPlannedParameter::sd_recorded)));
  view["alone"].push_back(percent_row(plan, "All", of_all(plan, &StoredPlannedParameter::sd_all)));
  view["record_count"] = fmt::format("{}", plan.records.size());
  view["plots"] = Json::array();
  for (const Figure& figure : plan_figures(plan))
    view["plots"].push_back({{"svg_html", svg(figure.plot)}});
  view["messages"] = plan.messages;
  view["has_messages"] = !plan.messages.empty();
  view["has_problems"] = !view["problems"].empty();
  return view;
}

}  // namespace rigcal::report
