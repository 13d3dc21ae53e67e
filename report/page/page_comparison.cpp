#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common/calendar.hpp"
#include "report/comparison/comparison_parts.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

Json estimate_cell(const std::optional<StoredEstimate>& estimate, const RowUnit& unit) {
  if (!estimate) return {{"there", false}};
  const Json shown = shown_estimate(estimate->value, estimate->ci95, unit.si);
  const Json& interval = shown.at("interval");
  return {{"there", true},
          {"value", shown.at("value")},
          {"fitted", estimate->fitted},
          {"interval", interval.at("known")},
          {"low", interval.at("low")},
          {"high", interval.at("high")},
          {"doubtful", is_doubtful(estimate->identifiability)},
          {"grade", grade_words(estimate->identifiability)}};
}

Json change_cell(const std::optional<StoredDifference>& difference, const RowUnit& unit) {
  if (!difference) return {{"there", false}};
  const std::string by = change_text(*difference, unit);
  const auto& p = difference->p_value_of_all;
  const bool significant = p && difference->significant == true;
  return {{"there", !by.empty()},
          {"by", by},
          {"exact", shown_in(difference->difference, 1.0).at("exact")},
          {"judged", p.has_value()},
          {"p", p ? p_value_text(*p) : std::string()},
          {"class", !p            ? "none"
                    : significant ? "warn"
                                  : "good"},
          {"word", p ? significant ? "significant" : "not significant"
                   : difference->reason == kKnownInBoth ? "known in both"
                                                        : "not tested"},
          {"reason", difference->reason.value_or("")}};
}

Json parameter_rows(const StoredComparison& comparison) {
  Json rows = Json::array();
  for (const StoredComparedParameter& parameter : comparison.parameters) {
    if (!worth_a_row(parameter)) continue;
    const RowUnit unit = unit_of_estimates(parameter);
    Json cells = Json::array();
    for (std::size_t i = 0; i < parameter.estimates.size(); ++i) {
      Json cell{{"estimate", estimate_cell(parameter.estimates[i], unit)}};
      cell["later"] = i > 0;
      cell["change"] = change_cell(parameter.differences.at(i), unit);
      cells.push_back(std::move(cell));
    }
    rows.push_back({{"name", parameter_label(parameter)},
                    {"unit", unit.name.empty() ? std::string("1") : unit.name},
                    {"cells", std::move(cells)}});
  }
  return rows;
}

/// Each fitted parameter by result, with its interval.
std::vector<Figure> parameter_figures(const StoredComparison& comparison) {
  std::vector<Figure> figures;
  for (const StoredComparedParameter& parameter : comparison.parameters) {
    const RowUnit unit = unit_of_estimates(parameter);
    Trace spans = empty_trace(Trace::Kind::intervals, "model");
    Trace middles = empty_trace(Trace::Kind::points, "model");
    double number = 0.0;
    for (const auto& estimate : parameter.estimates) {
      number += 1.0;
      if (!estimate || !estimate->fitted || !estimate->value) continue;
      middles.x.push_back(number);
      middles.y.push_back(*estimate->value / unit.si);
      add_interval(spans, number, estimate->ci95, unit.si);
    }
    if (middles.x.size() < 2) continue;
    const std::string label = parameter_label(parameter);
    Plot plot;
    plot.title = fmt::format("{} by result, with 95 % intervals", label);
    plot.x_label = "result";
    plot.y_label = unit.name.empty() ? label : fmt::format("{} [{}]", label, unit.name);
    plot.width = 300.0;
    plot.height = 170.0;
    plot.whole_x = true;
    plot.traces = {std::move(spans), std::move(middles)};
    figures.push_back({"comparison_" + plain_name(label), std::move(plot)});
  }
  return figures;
}

/// A series along dates or temperatures.
struct TrendAxis {
  const char* key;
  std::optional<double> StoredTrendPoint::*place;
  const char* per_unit;
  bool by_day;
  const StoredTrend& trend_of(const StoredSeries& series) const {
    if (by_day) return series.along_date;
    return series.along_temperature;
  }
};
constexpr std::array kTrendAxes{
    TrendAxis{"day", &StoredTrendPoint::day, "per day", true},
    TrendAxis{"temperature_k", &StoredTrendPoint::temperature_k, "per K", false}};

Plot trend_plot(const StoredSeries& series, const TrendAxis& axis) {
  Trace spans = empty_trace(Trace::Kind::intervals, "model");
  Trace middles = empty_trace(Trace::Kind::points, "model");
  double first = HUGE_VAL;
  double last = -HUGE_VAL;
  for (const StoredTrendPoint& point : series.points) {
    const auto& at = point.*axis.place;
    if (!at || !point.value) continue;
    first = std::min(first, *at);
    last = std::max(last, *at);
    middles.x.push_back(*at);
    middles.y.push_back(*point.value);
    add_interval(spans, *at, point.ci95);
  }
  const double origin = axis.by_day ? first : 273.15;
  Plot plot;
  plot.title = fmt::format("Leakage coefficient of {} along {}", series.of,
                           axis.by_day ? "dates" : "temperatures");
  plot.x_label = axis.by_day
                     ? "days since " + (std::isfinite(first) ? date_of(first) : std::string())
                     : std::string("temperature [°C]");
  plot.y_label = "leakage coefficient, " + series.of;
  plot.width = 460.0;
  plot.height = 220.0;
  const StoredTrend& trend = axis.trend_of(series);
  if (trend.slope && trend.intercept) {
    Trace line;
    line.style = "reference";
    line.x = {first, last};
    for (const double x : line.x) line.y.push_back(*trend.intercept + *trend.slope * x);
    plot.traces.push_back(std::move(line));
  }
  plot.traces.push_back(std::move(spans));
  plot.traces.push_back(std::move(middles));
  for (Trace& trace : plot.traces)
    for (double& x : trace.x) x -= origin;
  return plot;
}

/// Whether the points lie at several places.
bool differ(const StoredSeries& series, const TrendAxis& axis) {
  std::optional<double> first;
  for (const StoredTrendPoint& point : series.points) {
    const auto& at = point.*axis.place;
    if (first && at && *first != *at) return true;
    if (at) first = at;
  }
  return false;
}

std::string trend_reading(const StoredSeries& series, const TrendAxis& axis) {
  const StoredTrend& trend = axis.trend_of(series);
  if (!trend.slope || !trend.ci95 || !trend.p_value) return trend.reason.value_or("");
  return fmt::format("{}: {:+.3g} {} ({:.3g} to {:.3g}), {}: {}.", series.of, *trend.slope,
                     axis.per_unit, trend.ci95->low, trend.ci95->high, p_value_text(*trend.p_value),
                     trend.significant == true ? "significant trend" : "no significant trend");
}

Json trend_views(const StoredComparison& comparison) {
  Json list = Json::array();
  for (const StoredSeries& series : comparison.leak_trends) {
    for (const TrendAxis& axis : kTrendAxes) {
      if (!differ(series, axis)) continue;
      list.push_back(
          {{"svg_html", svg(trend_plot(series, axis))}, {"reading", trend_reading(series, axis)}});
    }
  }
  return list;
}

Json score_cell(const std::optional<StoredComparedScore>& score) {
  if (!score) return {{"there", false}};
  const bool failed = score->failure.has_value();
  return {{"there", true},
          {"failed", failed},
          {"badge", badge(failed ? std::optional(calib::Verdict::fail) : score->verdict)},
          {"rho2", shown_agreement(score->rho2)},
          {"error", shown_in(score->absolute_error_percent, 1.0, 3)},
          {"use", to_string(score->use)}};
}

Json score_rows_of(const StoredComparison& comparison) {
  Json rows = Json::array();
  for (const StoredComparedCondition& condition : comparison.conditions) {
    Json cells = Json::array();
    for (const auto& score : condition.scores) cells.push_back(score_cell(score));
    rows.push_back(
        {{"condition", condition.id}, {"channel", condition.channel}, {"cells", std::move(cells)}});
  }
  return rows;
}

Json metric_rows(const StoredComparison& comparison) {
  Json rows = Json::array();
  for (const StoredComparedMetric& metric : comparison.metrics) {
    for (std::size_t i = 1; i < metric.against_first.size(); ++i) {
      const auto& against = metric.against_first[i];
      if (!against) continue;
      const auto& p = against->p_value;
      rows.push_back({{"channel", metric.channel},
                      {"metric", metric.metric},
                      {"result", comparison.results.at(i).name},
                      {"conditions", fmt::format("{}", against->conditions)},
                      {"first", shown_score(metric.metric, against->mean_of_first)},
                      {"mean", shown_score(metric.metric, against->mean)},
                      {"better", fmt::format("{}", against->better)},
                      {"worse", fmt::format("{}", against->worse)},
                      {"p", p ? p_value_text(*p) : against->reason.value_or("")},
                      {"significant", against->significant == true}});
    }
  }
  return rows;
}

/// "1 to 2", or "1" where both are the same.
std::string span(const std::string& first, const std::string& last) {
  return first == last ? first : fmt::format("{} to {}", first, last);
}

Json result_rows(const StoredComparison& comparison) {
  Json rows = Json::array();
  for (const StoredComparedResult& result : comparison.results) {
    Json mark = badge(result.verdict);
    if (result.status != calib::FitStatus::converged)
      mark = {{"word", to_string(result.status)}, {"mark", "✕"}, {"class", "bad"}};
    std::string warm;
    if (const auto& kelvin = result.temperature_k)
      warm = span(fmt::format("{:.4g}", kelvin->low - 273.15),
                  fmt::format("{:.4g}", kelvin->high - 273.15));
    const auto& dates = result.dates;
    rows.push_back({{"number", fmt::format("{}", rows.size() + 1)},
                    {"name", result.name},
                    {"badge", std::move(mark)},
                    {"campaign", result.campaign},
                    {"model", result.model ? to_string(*result.model) : ""},
                    {"conditions", fmt::format("{}", result.conditions)},
                    {"dates", dates ? span((*dates)[0], (*dates)[1]) : std::string()},
                    {"temperature", warm},
                    {"cost", shown_in(result.cost, 1.0, 6)},
                    {"residuals", fmt::format("{}", result.residual_count)},
                    {"chi", shown_in(result.reduced_chi_square, 1.0, 4)},
                    {"command", result.command}});
  }
  return rows;
}

Json model_rows(const StoredComparison& comparison) {
  Json rows = Json::array();
  for (std::size_t i = 1; i < comparison.models.size(); ++i) {
    const StoredModelChoice model = comparison.models[i].value_or(StoredModelChoice());
    const auto& p = model.p_value;
    rows.push_back(
        {{"name", comparison.results.at(i).name},
         {"aic", shown_in(model.delta_aic, 1.0, 4)},
         {"bic", shown_in(model.delta_bic, 1.0, 4)},
         {"ratio", shown_in(model.likelihood_ratio, 1.0, 4)},
         {"freedom", p && model.freedom ? fmt::format("{}", *model.freedom) : std::string("–")},
         {"p", p ? p_value_text(*p) : std::string("–")},
         {"verdict", model.verdict.value_or("not compared")},
         {"reason", model.reason.value_or("")},
         {"has_reason", model.reason.has_value()}});
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
std::string significance_sentence(const StoredComparison& comparison) {
  long compared = 0;
  long tested = 0;
  long significant = 0;
  for (const auto& each : comparison.significance) {
    if (!each) continue;
    compared += each->compared;
    tested += each->tested;
    significant += each->significant;
  }
  const std::string differences =
      fmt::format("{} results, {} parameter difference{}", comparison.results.size(), compared,
                  compared == 1 ? "" : "s");
  if (compared == 0) return differences + ".";
  if (tested == 0) return differences + "; none could be tested for significance.";
  return fmt::format("{}: {} tested, {} significant, {} not tested.", differences, tested,
                     significant, compared - tested);
}

/// Adds the records, and how many are in all results.
void add_records(const StoredComparison& comparison, Json& view) {
  view["records"] = Json::array();
  std::size_t shared = 0;
  for (const StoredComparedRecord& record : comparison.records) {
    Json cells = Json::array();
    bool everywhere = true;
    for (const bool in : record.in) {
      cells.push_back(in ? "✓" : "–");
      everywhere = everywhere && in;
    }
    shared += everywhere ? 1 : 0;
    view["records"].push_back(
        {{"file", record.file}, {"sha256", record.sha256}, {"cells", std::move(cells)}});
  }
  view["record_count"] = fmt::format("{}", comparison.records.size());
  view["shared"] = fmt::format("{}", shared);
}

}  // namespace

Json comparison_headline(const StoredComparison& comparison) {
  const auto changes = changes_of(comparison);
  const bool different = !changes.empty() && changes.front().p.has_value();
  Json view = comparison.status != "done"
                  ? make_headline("FAILED", "✕", "bad",
                                  "Fewer than two results are usable: there is nothing to "
                                  "compare.")
                  : make_headline(different ? "DIFFERENT" : "COMPARED", different ? "!" : "○",
                                  different ? "warn" : "none", significance_sentence(comparison));
  for (const StoredComparedResult& result : comparison.results) {
    if (result.status == calib::FitStatus::converged) continue;
    view["class"] = "bad";
    add_reason(view,
               fmt::format("{}: {}: {}", result.name, to_string(result.status), result.message),
               "results");
  }
  for (const Change& change : changes) add_reason(view, change_sentence(change), "estimates");
  return view;
}

std::vector<Figure> comparison_figures(const StoredComparison& comparison) {
  std::vector<Figure> figures = parameter_figures(comparison);
  for (const StoredSeries& series : comparison.leak_trends) {
    for (const TrendAxis& axis : kTrendAxes) {
      if (!differ(series, axis)) continue;
      figures.push_back(
          {fmt::format("trend_{}_{}", axis.key, plain_name(series.of)), trend_plot(series, axis)});
    }
  }
  return figures;
}

Json comparison_view(const StoredComparison& comparison) {
  Json view;
  view["results"] = result_rows(comparison);
  view["significance"] = Json::array();
  for (std::size_t i = 1; i < comparison.significance.size(); ++i) {
    const auto& each = comparison.significance[i];
    view["significance"].push_back(
        fmt::format("{}: {}.", comparison.results.at(i).name, each ? each->text : std::string()));
  }
  view["parameters"] = parameter_rows(comparison);
  view["plots"] = Json::array();
  for (const Figure& figure : parameter_figures(comparison))
    view["plots"].push_back({{"svg_html", svg(figure.plot)}});
  view["metrics"] = metric_rows(comparison);
  view["models"] = model_rows(comparison);
  view["has_metrics"] = !view["metrics"].empty();
  view["conditions"] = score_rows_of(comparison);
  view["has_conditions"] = !view["conditions"].empty();
  view["trends"] = trend_views(comparison);
  view["has_trends"] = !view["trends"].empty();
  add_records(comparison, view);
  view["warnings"] = comparison.warnings;
  view["has_warnings"] = !comparison.warnings.empty();
  return view;
}

}  // namespace rigcal::report
