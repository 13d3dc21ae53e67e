#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common/calendar.hpp"
#include "report/comparison/comparison_parts.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

Json estimate_cell(const Json& estimate, const RowUnit& unit) {
  if (!estimate.is_object()) return {{"there", false}};
  const Json interval = shown_interval(estimate.at("ci95"), unit.si);
  const std::string grade = text_of(estimate, "identifiability");
  return {{"there", true},
          {"value", shown_matched(estimate.at("value"), estimate.at("ci95"), unit.si, 6)},
          {"fitted", estimate.at("fitted")},
          {"interval", interval.at("known")},
          {"low", interval.at("low")},
          {"high", interval.at("high")},
          {"doubtful", !grade.empty() && grade != "identified"},
          {"grade", grade == "not_identifiable" ? "not identifiable" : grade}};
}

Json change_cell(const Json& difference, const RowUnit& unit) {
  if (!difference.is_object()) return {{"there", false}};
  const std::string by = change_text(difference, unit);
  const auto p = number_of(difference, "p_value_of_all");
  const bool significant = p && difference.at("significant").get<bool>();
  return {{"there", !by.empty()},
          {"by", by},
          {"exact", shown_in(difference.at("difference"), 1.0).at("exact")},
          {"judged", p.has_value()},
          {"p", p ? p_value_text(*p) : std::string()},
          {"class", !p            ? "none"
                    : significant ? "warn"
                                  : "good"},
          {"word", p ? significant ? "significant" : "not significant"
                   : difference.at("reason") == kKnownInBoth ? "known in both"
                                                             : "not tested"},
          {"reason", text_of(difference, "reason")}};
}

Json parameter_rows(const Json& parameters) {
  Json rows = Json::array();
  for (const Json& parameter : parameters) {
    if (!worth_a_row(parameter)) continue;
    const RowUnit unit = unit_of_estimates(parameter);
    Json cells = Json::array();
    const Json& estimates = parameter.at("estimates");
    for (std::size_t i = 0; i < estimates.size(); ++i) {
      Json cell{{"estimate", estimate_cell(estimates[i], unit)}};
      cell["later"] = i > 0;
      cell["change"] = change_cell(parameter.at("differences").at(i), unit);
      cells.push_back(std::move(cell));
    }
    rows.push_back({{"name", parameter_label(parameter)},
                    {"unit", unit.name.empty() ? std::string("1") : unit.name},
                    {"cells", std::move(cells)}});
  }
  return rows;
}

/// Each fitted parameter by result, with its interval.
std::vector<Figure> parameter_figures(const Json& parameters) {
  std::vector<Figure> figures;
  for (const Json& parameter : parameters) {
    const RowUnit unit = unit_of_estimates(parameter);
    Trace spans = empty_trace(Trace::Kind::intervals, "model");
    Trace middles = empty_trace(Trace::Kind::points, "model");
    double number = 0.0;
    for (const Json& estimate : parameter.at("estimates")) {
      number += 1.0;
      if (!estimate.is_object() || !estimate.at("fitted").get<bool>()) continue;
      const auto value = number_of(estimate, "value");
      if (!value) continue;
      middles.x.push_back(number);
      middles.y.push_back(*value / unit.si);
      add_interval(spans, number, estimate.at("ci95"), unit.si);
    }
    if (middles.x.size() < 2) continue;
    Plot plot;
    plot.title = fmt::format("{} by result, with 95 % intervals", parameter_label(parameter));
    plot.x_label = "result";
    plot.y_label = unit.name.empty()
                       ? parameter_label(parameter)
                       : fmt::format("{} [{}]", parameter_label(parameter), unit.name);
    plot.width = 300.0;
    plot.height = 170.0;
    plot.whole_x = true;
    plot.traces = {std::move(spans), std::move(middles)};
    figures.push_back({"comparison_" + plain_name(parameter_label(parameter)), std::move(plot)});
  }
  return figures;
}

struct TrendAxis {
  const char* key;
  const char* trend;
  const char* slope;
  const char* per_unit;
};
constexpr std::array kTrendAxes{
    TrendAxis{"day", "along_date", "slope_per_day", "per day"},
    TrendAxis{"temperature_k", "along_temperature", "slope_per_k", "per K"}};

Plot trend_plot(const Json& series, const TrendAxis& axis) {
  const bool by_day = std::string_view(axis.key) == "day";
  Trace spans = empty_trace(Trace::Kind::intervals, "model");
  Trace middles = empty_trace(Trace::Kind::points, "model");
  double first = HUGE_VAL;
  double last = -HUGE_VAL;
  for (const Json& point : series.at("points")) {
    const auto at = number_of(point, axis.key);
    const auto value = number_of(point, "value");
    if (!at || !value) continue;
    first = std::min(first, *at);
    last = std::max(last, *at);
    middles.x.push_back(*at);
    middles.y.push_back(*value);
    add_interval(spans, *at, point.at("ci95"));
  }
  const double origin = by_day ? first : 273.15;
  Plot plot;
  plot.title = fmt::format("Leakage coefficient of {} along {}", text_of(series, "of"),
                           by_day ? "dates" : "temperatures");
  plot.x_label = by_day ? "days since " + (std::isfinite(first) ? date_of(first) : std::string())
                        : std::string("temperature [°C]");
  plot.y_label = "leakage coefficient, " + text_of(series, "of");
  plot.width = 460.0;
  plot.height = 220.0;
  const Json& trend = series.at(axis.trend);
  if (const auto slope = number_of(trend, axis.slope)) {
    Trace line;
    line.style = "reference";
    line.x = {first, last};
    for (const double x : line.x) line.y.push_back(*number_of(trend, "intercept") + *slope * x);
    plot.traces.push_back(std::move(line));
  }
  plot.traces.push_back(std::move(spans));
  plot.traces.push_back(std::move(middles));
  for (Trace& trace : plot.traces)
    for (double& x : trace.x) x -= origin;
  return plot;
}

bool differ(const Json& points, const char* key) {
  std::optional<double> first;
  for (const Json& point : points) {
    const auto value = number_of(point, key);
    if (!value) continue;
    if (first && *first != *value) return true;
    first = value;
  }
  return false;
}

Json trend_views(const Json& trends) {
  Json list = Json::array();
  for (const Json& series : trends) {
    for (const TrendAxis& axis : kTrendAxes) {
      if (!differ(series.at("points"), axis.key)) continue;
      const Json& trend = series.at(axis.trend);
      const auto slope = number_of(trend, axis.slope);
      std::string reading = text_of(trend, "reason");
      if (slope) {
        const double p = trend.at("p_value").get<double>();
        reading = fmt::format(
            "{}: {:+.3g} {} ({:.3g} to {:.3g}), {}: {}.", text_of(series, "of"), *slope,
            axis.per_unit, trend.at("ci95").at(0).get<double>(),
            trend.at("ci95").at(1).get<double>(), p_value_text(p),
            trend.at("significant").get<bool>() ? "significant trend" : "no significant trend");
      }
      list.push_back({{"svg_html", svg(trend_plot(series, axis))}, {"reading", reading}});
    }
  }
  return list;
}

Json score_rows_of(const Json& conditions) {
  Json rows = Json::array();
  for (const Json& condition : conditions) {
    Json cells = Json::array();
    for (const Json& score : condition.at("scores")) {
      Json cell{{"there", score.is_object()}};
      if (score.is_object()) {
        const bool failed = !text_of(score, "failure").empty();
        cell["failed"] = failed;
        cell["badge"] = badge(failed ? Json("FAIL") : score.at("verdict"));
        cell["rho2"] = shown_agreement(score.at("rho2"));
        cell["error"] = shown_in(score.at("absolute_error_percent"), 1.0, 3);
        cell["use"] = text_of(score, "use");
      }
      cells.push_back(std::move(cell));
    }
    rows.push_back({{"condition", text_of(condition, "id")},
                    {"channel", text_of(condition, "channel")},
                    {"cells", std::move(cells)}});
  }
  return rows;
}

Json metric_rows(const Json& comparison) {
  Json rows = Json::array();
  for (const Json& metric : comparison.at("metrics")) {
    const Json& against = metric.at("against_first");
    for (std::size_t i = 1; i < against.size(); ++i) {
      if (!against.at(i).is_object()) continue;
      const auto p = number_of(against.at(i), "p_value");
      rows.push_back(
          {{"channel", text_of(metric, "channel")},
           {"metric", text_of(metric, "metric")},
           {"result", text_of(comparison.at("results").at(i), "name")},
           {"conditions", fmt::format("{}", against.at(i).at("conditions").get<int>())},
           {"first", shown_score(text_of(metric, "metric"), against.at(i).at("mean_of_first"))},
           {"mean", shown_score(text_of(metric, "metric"), against.at(i).at("mean"))},
           {"better", fmt::format("{}", against.at(i).at("better").get<int>())},
           {"worse", fmt::format("{}", against.at(i).at("worse").get<int>())},
           {"p", p ? p_value_text(*p) : text_of(against.at(i), "reason")},
           {"significant", against.at(i).at("significant") == true}});
    }
  }
  return rows;
}

Json result_rows(const Json& results) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Json& result = results.at(i);
    const std::string status = text_of(result, "status");
    Json mark = badge(result.at("verdict"));
    if (status != "converged") mark = {{"word", status}, {"mark", "✕"}, {"class", "bad"}};
    const Json& dates = result.at("dates");
    const Json& kelvin = result.at("temperature_k");
    std::string when;
    if (dates.is_array()) {
      when = dates.at(0).get<std::string>();
      if (dates.at(0) != dates.at(1)) when += " to " + dates.at(1).get<std::string>();
    }
    std::string warm;
    if (kelvin.is_array()) {
      warm = fmt::format("{:.4g}", kelvin.at(0).get<double>() - 273.15);
      if (kelvin.at(0) != kelvin.at(1))
        warm += fmt::format(" to {:.4g}", kelvin.at(1).get<double>() - 273.15);
    }
    rows.push_back({{"number", fmt::format("{}", i + 1)},
                    {"name", text_of(result, "name")},
                    {"badge", std::move(mark)},
                    {"campaign", text_of(result, "campaign")},
                    {"model", text_of(result, "model")},
                    {"conditions", fmt::format("{}", result.at("conditions").get<int>())},
                    {"dates", when},
                    {"temperature", warm},
                    {"cost", shown_in(result.at("cost"), 1.0, 6)},
                    {"residuals", fmt::format("{}", result.at("residual_count").get<long>())},
                    {"chi", shown_in(result.at("reduced_chi_square"), 1.0, 4)},
                    {"command", text_of(result, "command")}});
  }
  return rows;
}

Json model_rows(const Json& comparison) {
  Json rows = Json::array();
  const Json& models = comparison.at("models");
  for (std::size_t i = 1; i < models.size(); ++i) {
    const Json& model = models.at(i);
    const auto p = number_of(model, "p_value");
    const std::string verdict = text_of(model, "verdict");
    rows.push_back({{"name", text_of(comparison.at("results").at(i), "name")},
                    {"aic", shown_in(model.at("delta_aic"), 1.0, 4)},
                    {"bic", shown_in(model.at("delta_bic"), 1.0, 4)},
                    {"ratio", shown_in(model.at("likelihood_ratio"), 1.0, 4)},
                    {"freedom", p ? fmt::format("{}", model.at("freedom").get<int>()) : "–"},
                    {"p", p ? p_value_text(*p) : std::string("–")},
                    {"verdict", verdict.empty() ? std::string("not compared") : verdict},
                    {"reason", text_of(model, "reason")},
                    {"has_reason", !text_of(model, "reason").empty()}});
  }
  return rows;
}

std::string change_sentence(const Change& change) {
  const std::string text =
      fmt::format("{} differs in {} by {}", change.parameter, change.result, change.by);
  return change.p ? fmt::format("{} ({})", text, p_value_text(*change.p))
                  : fmt::format("{}, not tested: {}", text, change.reason);
}

/// What the tests found, and how many parameters they left out.
std::string significance_sentence(const Json& comparison) {
  long compared = 0;
  long tested = 0;
  long significant = 0;
  for (const Json& each : comparison.at("significance")) {
    if (!each.is_object()) continue;
    compared += count_at(each, "compared");
    tested += count_at(each, "tested");
    significant += count_at(each, "significant");
  }
  const std::string differences =
      fmt::format("{} results, {} parameter difference{}", comparison.at("results").size(),
                  compared, compared == 1 ? "" : "s");
  if (compared == 0) return differences + ".";
  if (tested == 0) return differences + "; none could be tested for significance.";
  return fmt::format("{}: {} tested, {} significant, {} not tested.", differences, tested,
                     significant, compared - tested);
}

}  // namespace

Json comparison_headline(const Json& comparison) {
  const Json& results = comparison.at("results");
  const auto changes = changes_of(comparison);
  const bool failed = text_of(comparison, "status") != "done";
  const bool different = !changes.empty() && changes.front().p.has_value();
  Json view = failed
                  ? make_headline("FAILED", "✕", "bad",
                                  "Fewer than two results are usable: there is nothing to "
                                  "compare.")
                  : make_headline(different ? "DIFFERENT" : "COMPARED", different ? "!" : "○",
                                  different ? "warn" : "none", significance_sentence(comparison));
  for (const Json& result : results) {
    if (text_of(result, "status") == "converged") continue;
    view["class"] = "bad";
    add_reason(view,
               fmt::format("{}: {}: {}", text_of(result, "name"), text_of(result, "status"),
                           text_of(result, "message")),
               "results");
  }
  for (const Change& change : changes) add_reason(view, change_sentence(change), "estimates");
  return view;
}

std::vector<Figure> comparison_figures(const Json& comparison) {
  std::vector<Figure> figures = parameter_figures(comparison.at("parameters"));
  for (const Json& series : comparison.at("leak_trends")) {
    for (const TrendAxis& axis : kTrendAxes) {
      if (!differ(series.at("points"), axis.key)) continue;
      figures.push_back({fmt::format("trend_{}_{}", axis.key, plain_name(text_of(series, "of"))),
                         trend_plot(series, axis)});
    }
  }
  return figures;
}

Json comparison_view(const Json& comparison) {
  Json view;
  view["results"] = result_rows(comparison.at("results"));
  view["significance"] = Json::array();
  for (std::size_t i = 1; i < comparison.at("significance").size(); ++i) {
    view["significance"].push_back(
        fmt::format("{}: {}.", text_of(comparison.at("results").at(i), "name"),
                    text_of(comparison.at("significance").at(i), "text")));
  }
  view["parameters"] = parameter_rows(comparison.at("parameters"));
  view["plots"] = Json::array();
  for (const Figure& figure : parameter_figures(comparison.at("parameters")))
    view["plots"].push_back({{"svg_html", svg(figure.plot)}});
  view["metrics"] = metric_rows(comparison);
  view["models"] = model_rows(comparison);
  view["has_metrics"] = !view["metrics"].empty();
  view["conditions"] = score_rows_of(comparison.at("conditions"));
  view["has_conditions"] = !view["conditions"].empty();
  view["trends"] = trend_views(comparison.at("leak_trends"));
  view["has_trends"] = !view["trends"].empty();
  view["records"] = Json::array();
  std::size_t shared = 0;
  for (const Json& record : comparison.at("records")) {
    Json cells = Json::array();
    bool everywhere = true;
    for (const Json& in : record.at("in")) {
      cells.push_back(in.get<bool>() ? "✓" : "–");
      everywhere = everywhere && in.get<bool>();
    }
    shared += everywhere ? 1 : 0;
    view["records"].push_back({{"file", text_of(record, "file")},
                               {"sha256", text_of(record, "sha256")},
                               {"cells", std::move(cells)}});
  }
  view["record_count"] = fmt::format("{}", view["records"].size());
  view["shared"] = fmt::format("{}", shared);
  view["warnings"] = comparison.at("warnings");
  view["has_warnings"] = !comparison.at("warnings").empty();
  return view;
}

}  // namespace rigcal::report
