#include <fmt/format.h>

#include <algorithm>

#include "common/parallel.hpp"
#include "metrics/distributions.hpp"
#include "report/document/quantity.hpp"
#include "report/document/render_html.hpp"
#include "report/document/words.hpp"
#include "report/figure/time_plots.hpp"
#include "report/page/calibration/fit_sections.hpp"
#include "report/page/calibration/page_agreement_figures.hpp"
#include "report/page/calibration/score_columns.hpp"
#include "report/page/calibration/shown_part.hpp"
#include "report/page/page_parts.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

using Kind = doc::Column::Kind;

void add_scores(const calib::ConditionResult& condition, doc::Blocks& blocks) {
  if (condition.channels.empty()) return;
  const bool uncertain =
      std::any_of(condition.channels.begin(), condition.channels.end(),
                  [](const auto& each) { return each.printed_uncertainty() != nullptr; });
  if (uncertain)
    blocks.emplace_back(doc::reading(
        "± expanded uncertainty of a score (95 %, two-sided), from the variation between "
        "repeats and the stated uncertainty of the sensors."));
  doc::Table table{"Scores of " + condition.id};
  table.columns = {{"Channel"}};
  for (doc::Column& column : score_columns()) table.columns.push_back(std::move(column));
  for (const char* title : {"Noise ceiling of rho2", "Gain ratio", "Phase °", "Delay"})
    table.columns.push_back({title, Kind::number});
  for (const calib::ChannelScore& score : condition.channels) {
    const calib::ChannelMetrics& scores = score.metrics;
    const doc::Badge verdict = doc::badge(condition.verdict_of(score.channel));
    const auto& floor = score.noise_floor;
    doc::Row row{
        {doc::Line{doc::Mark{verdict.state, verdict.words}, fmt::format(" {}", score.key())}}};
    for (doc::Cell& cell :
         score_cells(scores, score.printed_uncertainty(), info(score.channel).unit))
      row.cells.push_back(std::move(cell));
    for (doc::Quantity quantity :
         {doc::agreement(floor ? std::optional(floor->rho2) : std::nullopt),
          doc::in_unit(scores.gain_ratio, 1.0, 5), doc::in_unit(scores.phase_deg, 1.0, 2),
          doc::readable(scores.delay_s, "s", 2)})
      row.cells.push_back({doc::Line{std::move(quantity)}});
    if (scores.problem) row.notes = {*scores.problem};
    table.rows.push_back(std::move(row));
  }
  blocks.emplace_back(std::move(table));
}

doc::Line facts_of(const calib::ConditionResult& condition) {
  doc::Line facts;
  const auto add = [&](const std::string& text) {
    facts.emplace_back((facts.empty() ? "" : " · ") + text);
  };
  if (condition.waveform) add(std::string(to_string(*condition.waveform)));
  const auto quantity = [&](const std::optional<double>& value, const char* unit,
                            const char* name) {
    if (value) add(fmt::format("{}{}", name, readable(*value, unit, 5)));
  };
  quantity(condition.frequency_hz, "Hz", "");
  quantity(condition.amplitude_m, "m", "amplitude ");
  quantity(condition.amplitude_v.value_or(std::nullopt), "V", "amplitude ");
  quantity(condition.amplitude_n, "N", "amplitude ");
  quantity(condition.amplitude_pa, "Pa", "amplitude ");
  quantity(condition.amplitude_m_per_s2, "m/s²", "amplitude ");
  quantity(condition.amplitude_rad, "rad", "amplitude ");
  quantity(condition.amplitude_n_m, "N m", "amplitude ");
  if (condition.leak_level) add("leak " + *condition.leak_level);
  if (condition.temperature_k) add(fmt::format("{:.4g} °C", *condition.temperature_k - 273.15));
  if (condition.date) add(*condition.date);
  add("used to " + std::string(to_string(condition.use)));
  add(fmt::format("{} samples", condition.samples));
  return facts;
}

/// Describes a plot over time as JSON for the script on the page.
Json live_plot(const TimePlot& plot, SeriesData& data) {
  Json lines = Json::array();
  for (const TimeLine& line : plot.lines) {
    lines.push_back(
        {{"column", data.add(*line.values, plot.si)}, {"name", line.name}, {"style", line.style}});
  }
  Json entry{{"name", plot.name}, {"unit", plot.unit}, {"height", plot.height}};
  entry["lines"] = std::move(lines);
  entry["sd"] = plot.sd != nullptr ? Json(data.add(*plot.sd, *plot.lines.front().values, plot.si))
                                   : Json(nullptr);
  entry["prediction"] = nullptr;
  if (plot.prediction_sd == nullptr) return entry;
  const auto& middle =
      plot.prediction_middle != nullptr ? *plot.prediction_middle : *plot.prediction_sd;
  const auto line = std::find_if(plot.lines.begin(), plot.lines.end(), [&](const auto& each) {
    return each.values == plot.prediction_middle;
  });
  entry["prediction"] = {
      {"sd", data.add(*plot.prediction_sd, middle, plot.si)},
      {"middle",
       line == plot.lines.end()
           ? Json(nullptr)
           : entry["lines"][static_cast<std::size_t>(line - plot.lines.begin())]["column"]},
      {"factor", metrics::kNormal95}};
  return entry;
}

/// Adds the plots over time, with the data series for zooming.
///
/// @param points  approximate number of points per series
/// @return        number of plots
std::size_t add_plots(const calib::ConditionResult& condition, const Table& series,
                      std::size_t points, doc::Blocks& blocks) {
  if (series.columns.empty() || series.columns.front().empty()) return 0;
  SeriesData data(series, points);
  Json plots = Json::array();
  for (const TimePlot& plot : time_plots(series)) {
    blocks.emplace_back(
        doc::LivePlot{plots.size(), anchor(condition.id) + "_" + plot.name,
                      description(plot, series), fmt::format("{} [{}]", plot.title, plot.unit),
                      [plot, &series, id = condition.id] { return picture(plot, series, id); }});
    plots.push_back(live_plot(plot, data));
  }
  const std::size_t count = plots.size();
  if (count == 0) return 0;
  data.json()["plots"] = std::move(plots);
  const auto each = data.json()["samples_per_point"].get<std::size_t>();
  blocks.emplace_back(doc::Paragraph{
      {fmt::format(
          "From residuals/{}.csv{}.", condition.id,
          each > 1 ? fmt::format("; every {} samples are drawn as their minimum and maximum", each)
                   : std::string())},
      doc::Paragraph::Tone::source});
  blocks.emplace_back(doc::LiveSeries{data.text()});
  return count;
}

/// Describes a condition and lists its scores.
doc::Article facts_article(const calib::ConditionResult& condition) {
  const doc::Badge verdict = doc::badge(condition.verdict);
  doc::Article article{anchor(condition.id), {verdict, " " + condition.id}, {}};
  doc::Blocks& blocks = article.blocks;
  blocks.emplace_back(doc::Paragraph{facts_of(condition)});
  const auto problem = [&](const std::string& text) {
    blocks.emplace_back(doc::Paragraph{{text}, doc::Paragraph::Tone::problem});
  };
  if (condition.not_scored) problem("Not scored: " + *condition.not_scored);
  if (condition.failure) problem("Could not be simulated: " + *condition.failure);
  blocks.emplace_back(list_of(condition.reasons, verdict.state));
  doc::List doubts;
  doubts.state = doc::State::warn;
  for (const std::string& text : condition.warnings) doubts.items.push_back({"Recording: " + text});
  blocks.emplace_back(std::move(doubts));
  add_scores(condition, blocks);
  add_score_budgets(condition, blocks);
  return article;
}

/// @param series  contents of residuals/<condition>.csv
/// @param curves  entry for the condition in residual_tests.json, or null
/// @param open    whether the curves are unfolded
void add_curves(const calib::ConditionResult& condition, const Table& series,
                const calib::ChannelCurves* curves, std::size_t points, bool open,
                doc::Blocks& blocks) {
  doc::Fold curves_of{"", {}, open, "curves"};
  const std::size_t plots = add_plots(condition, series, points, curves_of.blocks);
  // Every scored condition must have a series. Without this message the page would look complete
  // although it is not.
  if (!condition.channels.empty() && plots == 0)
    blocks.emplace_back(doc::Paragraph{
        {fmt::format("residuals/{}.csv is missing or has no rows: nothing can be drawn.",
                     condition.id)},
        doc::Paragraph::Tone::problem});
  doc::Blocks agreement = agreement_blocks(condition.id, periodic_frequency(condition), series);
  if (!agreement.empty()) {
    doc::Fold fold{"Parity, histogram, gain and phase", std::move(agreement)};
    fold.style = "agreement";
    curves_of.blocks.emplace_back(std::move(fold));
  }
  add_residual_tests(condition, curves, curves_of.blocks);
  if (curves_of.blocks.empty()) return;
  curves_of.summary =
      fmt::format("Curves and residual tests ({} plot{} over time)", plots, plots == 1 ? "" : "s");
  blocks.emplace_back(std::move(curves_of));
}

/// Maximum number of points on a line in a sketch: two periods with up to 200 samples each.
constexpr std::size_t kSketchPoints = 400;

/// Returns the last two periods of the measured and simulated signals for the script on the page.
Json sketched_series(const calib::ConditionResult& condition, const Table& series) {
  if (series.columns.empty() || series.columns.front().empty()) return nullptr;
  Table part;
  const auto* time_s = series.find("time_s");
  const std::size_t first = time_s == nullptr ? 0 : first_of_last_periods(condition, *time_s);
  for (std::size_t i = 0; i < series.columns.size(); ++i) {
    const std::string& name = series.names[i];
    // Bands are left out because they would take as much space as the lines.
    if (name.starts_with("sd_") || name.starts_with("prediction_sd_")) continue;
    part.names.push_back(name);
    part.columns.emplace_back(series.columns[i].begin() + static_cast<std::ptrdiff_t>(first),
                              series.columns[i].end());
  }
  SeriesData data(part, kSketchPoints);
  Json plots = Json::array();
  for (const TimePlot& plot : time_plots(part)) {
    if (plot.name == "flows" || plot.name == "command") continue;
    plots.push_back(live_plot(plot, data));
    plots.back()["caption"] = fmt::format("{} [{}]", plot.title, plot.unit);
    plots.back()["description"] = description(plot, part);
  }
  data.json()["plots"] = std::move(plots);
  return std::move(data.json());
}

std::string plain_text(const doc::Line& line) {
  std::string text;
  for (const doc::Inline& part : line)
    if (const auto* words = std::get_if<std::string>(&part)) text += *words;
  return text;
}

/// @param series  null: the sketch has no curves
doc::Sketches::Sketch sketch_of(const calib::ConditionResult& condition, const Table* series) {
  doc::Sketches::Sketch sketch{
      anchor(condition.id), doc::badge(condition.verdict), {doc::Strong{condition.id}}, {}};
  for (const calib::ChannelScore& score : condition.channels) {
    sketch.line.emplace_back(" · " + spaced(std::string(score.key())) + " ");
    sketch.line.emplace_back(doc::agreement(score.metrics.rho2));
  }
  if (series == nullptr) return sketch;
  std::vector<std::string> texts{plain_text(facts_of(condition))};
  texts.insert(texts.end(), condition.reasons.begin(), condition.reasons.end());
  for (const std::string& text : condition.warnings) texts.push_back("Recording: " + text);
  texts.push_back("From residuals/" + condition.id + ".csv: the last two periods, or all of it.");
  sketch.json = Json{{"texts", texts}, {"series", sketched_series(condition, *series)}}.dump(
      -1, ' ', false, Json::error_handler_t::replace);
  return sketch;
}

/// Approximate total size of the interactive series on a page.
constexpr std::size_t kSeriesBytes = 3'600'000;
constexpr double kBytesPerPoint = 2.0 * 4.0 / 3.0;
constexpr std::size_t kLeastPoints = 2000;

/// Returns the number of points per series at which all series together reach that size.
std::size_t points_of(const Calibration& stored, const std::vector<std::size_t>& shown) {
  std::size_t columns = 0;
  for (const std::size_t i : shown) columns += stored.series(i)->columns.size();
  const auto points =
      static_cast<std::size_t>(static_cast<double>(kSeriesBytes) / kBytesPerPoint /
                               static_cast<double>(std::max<std::size_t>(1, columns)));
  return std::max(points, kLeastPoints);
}

}  // namespace

std::vector<Figure> condition_figures(const calib::ConditionResult& condition,
                                      const Table& series) {
  std::vector<Figure> figures;
  if (series.columns.empty() || series.columns.front().empty()) return figures;
  for (const TimePlot& plot : time_plots(series))
    figures.push_back({plot.name, picture(plot, series, condition.id)});
  for (ChannelAgreement& channel :
       channel_agreements(condition.id, periodic_frequency(condition), series)) {
    for (Figure& figure : channel.figures) figures.push_back(std::move(figure));
  }
  return figures;
}

doc::Section conditions_section(const Calibration& stored, int threads, bool curves) {
  const std::vector<calib::ConditionResult>& conditions = stored.result.conditions;
  doc::Section section{"conditions", "Conditions"};
  if (conditions.empty()) {
    section.blocks.emplace_back(doc::reading("No condition was scored."));
    return section;
  }
  const std::vector<std::size_t> shown = shown_in_full(conditions);
  const bool all = shown.size() == conditions.size();
  section.blocks.emplace_back(doc::Paragraph{
      {(all ? std::string()
            : fmt::format("The worst {} are shown in full, the others in one line each below. ",
                          shown.size())) +
       "Drag across a plot to zoom in time; all plots of a condition move together. Double-click "
       "or 0 shows all. Focus a plot for the keyboard: plus, minus, arrows."},
      doc::Paragraph::Tone::screen});
  const std::size_t points = curves ? points_of(stored, shown) : 0;
  std::vector<doc::Rendered> articles(conditions.size());
  std::vector<doc::Sketches::Sketch> sketches(conditions.size());
  // Each article is rendered immediately. Keeping the series of all articles would account for most
  // of the memory that a page needs.
  parallel_for(conditions.size(), threads, [&](std::size_t i) {
    const calib::ConditionResult& condition = conditions[i];
    const bool in_full = std::binary_search(shown.begin(), shown.end(), i);
    if (in_full) articles[i].blocks = {facts_article(condition)};
    const std::shared_ptr<const Table> series = curves ? stored.series(i) : nullptr;
    if (!in_full) {
      sketches[i] = sketch_of(condition, series.get());
      return;
    }
    if (!curves) return;
    const bool open = i == shown.front() || conditions.size() <= kFew;
    doc::Article article = std::get<doc::Article>(articles[i].blocks.front());
    add_curves(condition, *series, find(stored.curves.conditions, condition.id), points, open,
               article.blocks);
    doc::render_html({std::move(article)}, articles[i].html);
  });
  for (const std::size_t i : shown) section.blocks.emplace_back(std::move(articles[i]));
  if (all) return section;
  std::erase_if(sketches, [](const auto& sketch) { return sketch.id.empty(); });
  section.blocks.emplace_back(
      doc::Heading{{fmt::format("The other {} conditions", conditions.size() - shown.size())}, 3});
  section.blocks.emplace_back(doc::reading(
      "rho2 of each channel. Open a line for its last two periods; every sample is in its file in "
      "residuals/."));
  section.blocks.emplace_back(doc::Sketches{std::move(sketches)});
  return section;
}

}  // namespace rigcal::report
