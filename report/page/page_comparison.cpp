#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common/calendar.hpp"
#include "common/significant.hpp"
#include "report/comparison/comparison_parts.hpp"
#include "report/document/words.hpp"
#include "report/page/page_parts.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

using doc::Line;
using Kind = doc::Column::Kind;

/// Returns the change from the first result, or std::nullopt if there is nothing to report.
std::optional<doc::Line> change_line(const std::optional<calib::EstimateDifference>& difference,
                                     const ReadableUnit& unit) {
  if (!difference) return std::nullopt;
  const std::string by = change_text(*difference, unit);
  if (by.empty()) return std::nullopt;
  Line line{doc::Quantity{difference->difference, by}, " "};
  const auto& p = difference->p_value_of_all;
  if (!p) {
    const bool known = difference->reason == calib::kKnownInBoth;
    line.emplace_back(doc::Badge{doc::State::none, known ? "known in both" : "not tested"});
    return line;
  }
  const bool significant = difference->significant == true;
  line.emplace_back(doc::Badge{significant ? doc::State::warn : doc::State::good,
                               significant ? "significant" : "not significant"});
  line.emplace_back(" " + p_value_text(*p));
  return line;
}

doc::Cell estimate_cell(const std::optional<calib::ComparedEstimate>& estimate,
                        const ReadableUnit& unit) {
  if (!estimate) return doc::Cell("–");
  const doc::Estimate shown = doc::estimate(estimate->value, estimate->ci95, unit.si);
  doc::Cell cell{Line{shown.value}};
  if (!estimate->fitted) cell.line.emplace_back(doc::Soft{" known"});
  if (shown.has_interval) cell.below.push_back(shown.interval());
  if (is_doubtful(estimate->identifiability))
    cell.below.push_back({doc::badge(*estimate->identifiability)});
  return cell;
}

/// Adds a column for each result, headed by its number and name.
void add_result_columns(const StoredComparison& comparison, Kind kind, doc::Table& table) {
  for (std::size_t i = 0; i < comparison.results.size(); ++i)
    table.columns.push_back({fmt::format("{} {}", i + 1, comparison.results[i].name), kind});
}

doc::Table parameter_table_of(const StoredComparison& comparison) {
  doc::Table table{"Parameters side by side"};
  table.style = "estimates";
  table.columns = {{"Parameter"}, {"Unit"}};
  add_result_columns(comparison, Kind::number, table);
  for (const StoredComparedParameter& parameter : comparison.parameters) {
    if (!worth_a_row(parameter)) continue;
    const ReadableUnit unit = unit_of_estimates(parameter);
    doc::Row row{{parameter_label(parameter), unit.name.empty() ? std::string("1") : unit.name}};
    for (std::size_t i = 0; i < parameter.estimates.size(); ++i) {
      doc::Cell& cell = row.cells.emplace_back(estimate_cell(parameter.estimates[i], unit));
      auto change = i > 0 ? change_line(parameter.differences.at(i), unit) : std::nullopt;
      if (change) cell.below.push_back(std::move(*change));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Draws one figure for each fitted parameter: its estimate in each result, with intervals.
std::vector<Figure> parameter_figures(const StoredComparison& comparison) {
  std::vector<Figure> figures;
  for (const StoredComparedParameter& parameter : comparison.parameters) {
    const ReadableUnit unit = unit_of_estimates(parameter);
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
    Plot plot{fmt::format("{} by result, with 95 % intervals", label), "result",
              unit.name.empty() ? label : fmt::format("{} [{}]", label, unit.name), 300.0, 170.0};
    plot.whole_x = true;
    plot.traces = {std::move(spans), std::move(middles)};
    figures.push_back({"comparison_" + plain_name(label), std::move(plot)});
  }
  return figures;
}

/// The axis of a trend: dates or temperatures.
struct TrendAxis {
  const char* key;
  std::optional<double> StoredTrendPoint::*place;
  const char* per_unit;
  bool by_day;
  const calib::EstimateTrend& trend_of(const StoredSeries& series) const {
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
  Plot plot{
      fmt::format(
          "Leakage coefficient of {} along {}, with 95 % intervals; the line of the trend, if one "
          "could be tested, with its 95 % band",
          series.of, axis.by_day ? "dates" : "temperatures"),
      axis.by_day ? "days since " + (std::isfinite(first) ? date_of(first) : std::string())
                  : std::string("temperature [°C]"),
      "leakage coefficient, " + series.of, 460.0, 220.0};
  add_trend_line(plot, axis.trend_of(series), placed_estimates(series.points, axis.place),
                 {first, last});
  plot.traces.push_back(std::move(spans));
  plot.traces.push_back(std::move(middles));
  for (Trace& trace : plot.traces)
    for (double& x : trace.x) x -= origin;
  return plot;
}

/// Returns true if the points have at least two different positions.
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
  const calib::EstimateTrend& trend = axis.trend_of(series);
  if (!trend.slope || !trend.ci95 || !trend.p_value) return trend.reason.value_or("");
  return fmt::format("{}: {}{} {} ({} to {}), {}: {}.", series.of, *trend.slope < 0.0 ? "" : "+",
                     significant(*trend.slope, 3), axis.per_unit, significant(trend.ci95->low, 3),
                     significant(trend.ci95->high, 3), p_value_text(*trend.p_value),
                     trend.significant == true ? "significant trend" : "no significant trend");
}

doc::Tile score_tile(const StoredComparedScore& score) {
  if (score.failure) return {doc::badge(calib::Verdict::fail), {"not simulated"}};
  doc::Tile tile{doc::badge(score.verdict), {doc::agreement(score.rho2)}};
  tile.below = {{doc::in_unit(score.absolute_error_percent, 1.0, 3),
                 fmt::format(" % · {}", to_string(score.use))}};
  return tile;
}

doc::Table score_table(const StoredComparison& comparison) {
  doc::Table table{"Scores side by side"};
  table.caption = {"rho2, and the mean absolute error in percent of the range"};
  table.shape = doc::Table::Shape::matrix;
  table.columns = {{"Condition"}, {"Channel"}};
  add_result_columns(comparison, Kind::text, table);
  for (const StoredComparedCondition& condition : comparison.conditions) {
    doc::Row row{{condition.id, condition.channel}};
    for (const auto& score : condition.scores) {
      doc::Cell& cell = row.cells.emplace_back();
      if (score) cell.tiles = {score_tile(*score)};
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

doc::Table metric_table(const StoredComparison& comparison) {
  doc::Table table{"Means of the scores"};
  table.caption = {"Over the conditions that the first result has too; sign test over conditions"};
  table.heading = 2;
  table.columns = {{"Channel"},
                   {"Metric"},
                   {"Result"},
                   {"Conditions", Kind::number},
                   {"Mean of the first", Kind::number},
                   {"Mean", Kind::number},
                   {"Better in", Kind::number},
                   {"Worse in", Kind::number},
                   {"Significance"}};
  for (const StoredComparedMetric& metric : comparison.metrics) {
    for (std::size_t i = 1; i < metric.against_first.size(); ++i) {
      const auto& against = metric.against_first[i];
      if (!against) continue;
      const auto& p = against->p_value;
      Line significance{p ? p_value_text(*p) : against->reason.value_or("")};
      if (against->significant == true) {
        significance.emplace_back(" ");
        significance.emplace_back(doc::Badge{doc::State::warn, "significant"});
      }
      table.rows.push_back({{metric.channel,
                             metric.metric,
                             comparison.results.at(i).name,
                             fmt::format("{}", against->conditions),
                             doc::score(metric.metric, against->mean_of_first),
                             doc::score(metric.metric, against->mean),
                             fmt::format("{}", against->better),
                             fmt::format("{}", against->worse),
                             {std::move(significance)}}});
    }
  }
  return table;
}

/// Returns "1 to 2", or "1" if both are the same.
std::string span(const std::string& first, const std::string& last) {
  return first == last ? first : fmt::format("{} to {}", first, last);
}

doc::Table result_table(const StoredComparison& comparison) {
  doc::Table table{"Results side by side"};
  table.heading = 1;
  table.columns = {{"No.", Kind::number},
                   {"Result"},
                   {"Verdict"},
                   {"Campaign"},
                   {"Plant"},
                   {"Conditions", Kind::number},
                   {"Dates"},
                   {"Temperature, °C", Kind::number},
                   {"Cost", Kind::number},
                   {"Residuals", Kind::number},
                   {"Reduced chi-square", Kind::number}};
  for (const StoredComparedResult& result : comparison.results) {
    doc::Badge verdict = doc::badge(result.verdict);
    if (result.status != calib::FitStatus::converged)
      verdict = {doc::State::bad, std::string(to_string(result.status))};
    std::string warm;
    if (const auto& kelvin = result.temperature_k)
      warm = span(fmt::format("{:.4g}", kelvin->low - 273.15),
                  fmt::format("{:.4g}", kelvin->high - 273.15));
    const auto& dates = result.dates;
    table.rows.push_back(
        {{fmt::format("{}", table.rows.size() + 1), result.name, std::move(verdict),
          result.campaign, result.model ? std::string(to_string(*result.model)) : std::string(),
          fmt::format("{}", result.conditions),
          dates ? span((*dates)[0], (*dates)[1]) : std::string(), warm,
          doc::in_unit(result.cost, 1.0, 6), fmt::format("{}", result.residual_count),
          doc::in_unit(result.reduced_chi_square, 1.0, 4)}});
  }
  return table;
}

doc::Table model_table(const StoredComparison& comparison) {
  doc::Table table{"Models"};
  table.caption = {"AIC, BIC and likelihood ratio, against the first result"};
  table.style = "models";
  table.columns = {{"Result"},
                   {"AIC", Kind::number},
                   {"BIC", Kind::number},
                   {"Likelihood ratio", Kind::number},
                   {"Additional parameters", Kind::number},
                   {"Significance"},
                   {"In words", Kind::words}};
  for (std::size_t i = 1; i < comparison.models.size(); ++i) {
    const StoredModelChoice model = comparison.models[i].value_or(StoredModelChoice());
    const auto& p = model.p_value;
    doc::Cell words = doc::Cell(model.verdict.value_or("not compared"));
    if (model.reason) words.below = {{*model.reason}};
    table.rows.push_back(
        {{comparison.results.at(i).name, doc::in_unit(model.delta_aic, 1.0, 4),
          doc::in_unit(model.delta_bic, 1.0, 4), doc::in_unit(model.likelihood_ratio, 1.0, 4),
          p && model.freedom ? fmt::format("{}", *model.freedom) : std::string("–"),
          p ? p_value_text(*p) : std::string("–"), std::move(words)}});
  }
  return table;
}

std::string change_sentence(const Change& change) {
  const std::string text =
      fmt::format("{} differs in {} by {}", change.parameter, change.result, change.by);
  return change.p ? fmt::format("{} ({})", text, p_value_text(*change.p))
                  : fmt::format("{}, not tested: {}", text, change.reason);
}

/// Summarises the tests and the number of parameters that were not tested.
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

/// Lists every file with the results that used it.
doc::Section records_section(const StoredComparison& comparison) {
  doc::Table table{"Input files, and the results that used them"};
  table.style = "hashes";
  table.columns = {{"File"}};
  for (std::size_t i = 0; i < comparison.results.size(); ++i)
    table.columns.push_back({fmt::format("{}", i + 1)});
  table.columns.push_back({"SHA-256"});
  std::size_t shared = 0;
  for (const StoredComparedRecord& record : comparison.records) {
    doc::Row row{{record.file}};
    bool everywhere = true;
    for (const bool in : record.in) {
      row.cells.push_back(in ? "✓" : "–");
      everywhere = everywhere && in;
    }
    row.cells.push_back(record.sha256);
    shared += everywhere ? 1 : 0;
    table.rows.push_back(std::move(row));
  }
  return {"records",
          "Records",
          {doc::reading(fmt::format("{} of {} files were used for every result. Files are "
                                    "identified by content, not by name.",
                                    shared, comparison.records.size())),
           doc::Fold{"Every file", {std::move(table)}}}};
}

}  // namespace

doc::Verdict comparison_headline(const StoredComparison& comparison) {
  const auto changes = changes_of(comparison);
  const bool different = !changes.empty() && changes.front().p.has_value();
  doc::Verdict verdict{
      {different ? doc::State::warn : doc::State::none, different ? "DIFFERENT" : "COMPARED"},
      {significance_sentence(comparison)}};
  if (comparison.status != "done")
    verdict = {{doc::State::bad, "FAILED"},
               {"Fewer than two results are usable: there is nothing to compare."}};
  for (const StoredComparedResult& result : comparison.results) {
    if (result.status == calib::FitStatus::converged) continue;
    verdict.badge.state = doc::State::bad;
    add_reason(verdict,
               fmt::format("{}: {}: {}", result.name, to_string(result.status), result.message),
               "results");
  }
  for (const Change& change : changes) add_reason(verdict, change_sentence(change), "estimates");
  return verdict;
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

namespace {

/// Returns true if the error of any difference includes day-to-day differences.
bool has_other_dates(const StoredComparison& comparison) {
  for (const StoredComparedParameter& parameter : comparison.parameters)
    for (const auto& difference : parameter.differences)
      if (difference && difference->of_other_dates.value_or(false)) return true;
  return false;
}

}  // namespace

std::vector<doc::Section> comparison_sections(const StoredComparison& comparison) {
  std::vector<doc::Section> sections;
  sections.push_back({"results",
                      "Results side by side",
                      {result_table(comparison), list_of(comparison.warnings, doc::State::warn)},
                      "Results"});
  doc::Section estimates{"estimates",
                         "Parameters",
                         {doc::reading("95 % intervals. Change: relative to the first result; p "
                                       "value adjusted for all parameters together (Holm).")}};
  for (std::size_t i = 1; i < comparison.significance.size(); ++i) {
    const auto& each = comparison.significance[i];
    estimates.blocks.emplace_back(doc::reading(
        fmt::format("{}: {}.", comparison.results.at(i).name, each ? each->text : std::string())));
  }
  if (has_other_dates(comparison))
    estimates.blocks.emplace_back(doc::reading(
        "Fits of different dates: the standard error of a difference includes day-to-day variation "
        "(supply, oil, zero, trigger; [between_days] in the campaign)."));
  estimates.blocks.emplace_back(parameter_table_of(comparison));
  doc::Gallery gallery;
  for (Figure& figure : parameter_figures(comparison))
    gallery.figures.push_back(figure_of(std::move(figure.plot)));
  estimates.blocks.emplace_back(std::move(gallery));
  sections.push_back(std::move(estimates));
  sections.push_back(
      {"models",
       "Which model the records prefer",
       {doc::reading("Difference in AIC and BIC from the first result (negative favours this one), "
                     "and the likelihood-ratio test of nested models. Autocorrelation is taken "
                     "into account by the effective sample size."),
        model_table(comparison)},
       "Models"});
  doc::Gallery trends;
  trends.wide = true;
  for (const StoredSeries& series : comparison.leak_trends) {
    for (const TrendAxis& axis : kTrendAxes) {
      if (differ(series, axis))
        trends.figures.push_back(figure_of(trend_plot(series, axis),
                                           axis.by_day
                                               ? "Does the leak change over time?"
                                               : "Does the leak change with the temperature?",
                                           trend_reading(series, axis)));
    }
  }
  if (!trends.figures.empty())
    sections.push_back({"trends", "Trend of the leak", {std::move(trends)}, "Trend"});
  if (!comparison.conditions.empty()) {
    doc::Section scores{"scores", "Scores"};
    doc::Table means = metric_table(comparison);
    if (!means.rows.empty()) scores.blocks.emplace_back(std::move(means));
    scores.blocks.emplace_back(score_table(comparison));
    sections.push_back(std::move(scores));
  }
  sections.push_back(records_section(comparison));
  return sections;
}

}  // namespace rigcal::report
