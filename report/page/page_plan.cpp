#include "report/page/page_plan.hpp"

#include <fmt/format.h>

#include <cmath>

#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

std::string plan_label(const Json& parameter) {
  const std::string level = text_of(parameter, "level");
  const std::string name = text_of(parameter, "name");
  return level.empty() ? name : fmt::format("{} ({})", name, level);
}

std::optional<double> at_number(const Json& list, std::size_t i) {
  if (!list.is_array() || i >= list.size() || !list.at(i).is_number()) return std::nullopt;
  return list.at(i).get<double>();
}

/// A standard deviation in percent of the value; a dash where there is none.
std::string percent_text(const std::optional<double>& sd, const std::optional<double>& value) {
  if (!sd || !value || *value == 0.0) return "–";
  const double percent = 100.0 * *sd / std::abs(*value);
  return percent > 1000.0 ? std::string("> 1000") : fmt::format("{:.3g}", percent);
}

bool determined(const Json& parameter) { return number_of(parameter, "sd_all").has_value(); }

Json record_row(const Json& plan, const Json& record, const char* key, const std::string& label) {
  Json cells = Json::array();
  const Json& parameters = plan.at("parameters");
  for (std::size_t j = 0; j < parameters.size(); ++j)
    cells.push_back(
        percent_text(at_number(record.at(key), j), number_of(parameters.at(j), "value")));
  return {{"label", label}, {"cells", std::move(cells)}};
}

Json total_row(const Json& plan, const char* key, const std::string& label) {
  Json cells = Json::array();
  for (const Json& parameter : plan.at("parameters"))
    cells.push_back(percent_text(number_of(parameter, key), number_of(parameter, "value")));
  return {{"label", label}, {"cells", std::move(cells)}};
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

std::vector<Figure> plan_figures(const Json& plan) {
  std::vector<Figure> figures;
  const Json& records = plan.at("records");
  const Json& parameters = plan.at("parameters");
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const auto all = number_of(parameters.at(j), "sd_all");
    if (!all || !(*all > 0.0)) continue;
    Plot plot;
    plot.title = fmt::format("{}: share of the precision of all records that each has alone",
                             plan_label(parameters.at(j)));
    plot.x_label = "record";
    plot.y_label = fmt::format("{} [%]", plan_label(parameters.at(j)));
    plot.width = 300.0;
    plot.height = 150.0;
    plot.whole_x = true;
    plot.levels = {0.0};
    for (std::size_t i = 0; i < records.size(); ++i) {
      const auto alone = at_number(records.at(i).at("sd_alone"), j);
      const double share = alone && *alone > 0.0 ? std::pow(*all / *alone, 2) : 0.0;
      plot.traces.push_back(bar(static_cast<double>(i + 1), 100.0 * share,
                                records.at(i).at("recorded").get<bool>() ? "residual" : "model"));
    }
    figures.push_back({"plan_" + plain_name(plan_label(parameters.at(j))), std::move(plot)});
  }
  return figures;
}

Json plan_headline(const Json& plan) {
  const Json& records = plan.at("records");
  const Json& parameters = plan.at("parameters");
  std::size_t recorded = 0;
  for (const Json& record : records) recorded += record.at("recorded").get<bool>() ? 1 : 0;
  std::size_t told = 0;
  for (const Json& parameter : parameters) told += determined(parameter) ? 1 : 0;
  const bool whole = told == parameters.size();
  Json view = make_headline(
      "PLAN", whole ? "✓" : "!", whole ? "good" : "warn",
      fmt::format("{} of {} records exist; all together determine {} of {} parameters.", recorded,
                  records.size(), told, parameters.size()));
  for (const Json& parameter : parameters) {
    const std::string remedy = text_of(parameter, "remedy");
    if (!determined(parameter))
      add_reason(view,
                 fmt::format("{} is not determined{}{}", plan_label(parameter),
                             remedy.empty() ? "" : ": ", remedy),
                 "plan");
  }
  for (const Json& message : plan.at("messages"))
    add_reason(view, message.get<std::string>(), "plan");
  return view;
}

Json plan_view(const Json& plan) {
  Json view;
  const Json& records = plan.at("records");
  view["parameters"] = Json::array();
  view["totals"] = Json::array();
  for (const Json& parameter : plan.at("parameters")) {
    const RowUnit unit =
        row_unit(number_of(parameter, "value").value_or(0.0), text_of(parameter, "unit"));
    view["parameters"].push_back({{"name", plan_label(parameter)}});
    view["totals"].push_back({{"name", plan_label(parameter)},
                              {"unit", unit.name.empty() ? std::string("1") : unit.name},
                              {"value", shown_in(parameter.at("value"), unit.si, 5)},
                              {"recorded", shown_in(parameter.at("sd_recorded"), unit.si, 2)},
                              {"all", shown_in(parameter.at("sd_all"), unit.si, 2)},
                              {"remedy", text_of(parameter, "remedy")}});
  }
  view["alone"] = Json::array();
  view["without"] = Json::array();
  view["problems"] = Json::array();
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Json& record = records.at(i);
    const std::string id = text_of(record, "condition");
    const std::string label =
        fmt::format("{} {}{}", i + 1, id, record.at("recorded").get<bool>() ? "" : " (planned)");
    view["alone"].push_back(record_row(plan, record, "sd_alone", label));
    view["without"].push_back(record_row(plan, record, "sd_without", label));
    if (const std::string problem = text_of(record, "problem"); !problem.empty())
      view["problems"].push_back(fmt::format("{}: {}", id, problem));
  }
  view["alone"].push_back(total_row(plan, "sd_recorded", "All that are recorded"));
  view["alone"].push_back(total_row(plan, "sd_all", "All"));
  view["record_count"] = fmt::format("{}", records.size());
  view["plots"] = Json::array();
  for (const Figure& figure : plan_figures(plan))
    view["plots"].push_back({{"svg_html", svg(figure.plot)}});
  view["messages"] = plan.at("messages");
  view["has_messages"] = !plan.at("messages").empty();
  view["has_problems"] = !view["problems"].empty();
  return view;
}

}  // namespace rigcal::report
