#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/calendar.hpp"
#include "report/batch/batch.hpp"
#include "report/comparison/comparison_parts.hpp"
#include "report/document/words.hpp"
#include "report/page/section.hpp"

namespace rigcal::report {
namespace {

using Kind = doc::Column::Kind;

/// Number of warnings per rig in the overview; the report of the rig lists all.
constexpr std::size_t kShownWarnings = 3;

/// Converts a relative path to a link with reserved characters escaped.
std::string as_link(const std::string& path) {
  std::string link;
  for (const char c : path) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '/' || c == '.' || c == '-' || c == '_';
    link += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return link;
}

doc::Badge rig_badge(const StoredRig& rig) {
  if (!rig.status) return {doc::State::bad, "no result"};
  if (!has_converged(rig)) return {doc::State::bad, std::string(to_string(*rig.status))};
  return doc::badge(rig.verdict);
}

doc::Cell score_lines(const StoredRig& rig) {
  doc::Cell cell;
  for (const StoredRigScore& score : rig.worst_scores) {
    if (!score.failure.empty()) {
      cell.paragraphs.push_back({score.condition + ": not simulated"});
      continue;
    }
    cell.paragraphs.push_back({fmt::format("{} {}: ", score.condition, score.channel),
                               doc::agreement(score.rho2), ", ",
                               doc::in_unit(score.absolute_error_percent, 1.0, 3), " %"});
  }
  return cell;
}

doc::Cell estimate_lines(const StoredRig& rig) {
  doc::Cell cell;
  for (const StoredRigEstimate& each : rig.parameters) {
    const ReadableUnit unit = readable_unit(each.value, each.unit);
    const doc::Estimate shown = doc::estimate(each.value, each.ci95, unit.si);
    doc::Quantity value = shown.value;
    value.unit = unit.name;
    doc::Line line{parameter_label(each) + " ", std::move(value)};
    if (shown.has_interval) {
      line.emplace_back(" (");
      for (doc::Inline& part : shown.interval()) line.push_back(std::move(part));
      line.emplace_back(")");
    }
    if (is_doubtful(each.identifiability)) {
      line.emplace_back(" ");
      line.emplace_back(doc::badge(*each.identifiability));
    }
    cell.paragraphs.push_back(std::move(line));
  }
  return cell;
}

/// Plots the estimates over the days since the first one. Returns std::nullopt if fewer than two
/// have a date.
std::optional<Plot> rig_trend_plot(const StoredRig& rig, const StoredRigTrend& trend) {
  const std::vector<StoredTrendPoint>& points = trend.series.points;
  double first = std::numeric_limits<double>::infinity();
  double last = -first;
  double largest = 0.0;
  int dated = 0;
  for (const StoredTrendPoint& point : points) {
    if (!point.day || !point.value) continue;
    first = std::min(first, *point.day);
    last = std::max(last, *point.day);
    largest = std::max(largest, std::abs(*point.value));
    ++dated;
  }
  if (dated < 2) return std::nullopt;
  const ReadableUnit unit = readable_unit(largest, trend.unit);
  Trace spans = empty_trace(Trace::Kind::intervals, "model");
  Trace middles = empty_trace(Trace::Kind::points, "model");
  for (const StoredTrendPoint& point : points) {
    if (!point.day || !point.value) continue;
    middles.x.push_back(*point.day - first);
    middles.y.push_back(*point.value / unit.si);
    add_interval(spans, *point.day - first, point.ci95, unit.si);
  }
  Plot plot{
      fmt::format("{} of {} over time, with 95 % intervals and band", trend_name(trend), rig.rig),
      "days since " + date_of(first),
      trend_name(trend) + (unit.name.empty() ? "" : fmt::format(" [{}]", unit.name)), 300.0, 170.0};
  add_trend_line(plot, trend.series.along_date, placed_estimates(points, &StoredTrendPoint::day),
                 {first, last}, unit.si);
  for (Trace& trace : plot.traces)
    for (double& day : trace.x) day -= first;
  plot.traces.push_back(std::move(spans));
  plot.traces.push_back(std::move(middles));
  return plot;
}

/// Lists why a rig is not PASS, and its first warnings.
doc::Cell reason_lines(const StoredRig& rig) {
  doc::Cell cell;
  if (!has_converged(rig) || rig.exit_code > 1) cell.paragraphs.push_back({rig.message});
  for (const std::string& reason : rig.reasons) cell.paragraphs.push_back({reason});
  const std::size_t shown = std::min(rig.warnings.size(), kShownWarnings);
  for (std::size_t i = 0; i < shown; ++i) cell.paragraphs.push_back({rig.warnings[i]});
  if (rig.warnings.size() > shown)
    cell.paragraphs.push_back({fmt::format("{} in all", rig.warnings.size())});
  return cell;
}

doc::Row rig_row(const StoredRig& rig) {
  doc::Cell name = doc::Cell(rig.rig);
  if (rig.has_report) name.line = {doc::Link{as_link(rig.folder + "/report.html"), rig.rig}};
  name.below = {{rig.name.value_or("")}};
  doc::Cell verdict{doc::Line{rig_badge(rig)}};
  if (rig.unchanged) verdict.below = {{"unchanged"}};
  return {{std::move(name), std::move(verdict), score_lines(rig), estimate_lines(rig),
           reason_lines(rig), fmt::format("{}", rig.exit_code), doc::in_unit(rig.seconds, 1.0, 3)},
          {},
          "rig-" + anchor(rig.rig)};
}

doc::Section trends_section(const StoredBatch& batch) {
  doc::Section section{"rig-trends", "Trends"};
  bool any = false;
  for (const StoredRig& rig : batch.rigs) {
    doc::Gallery gallery;
    for (const StoredRigTrend& trend : rig.trends) {
      auto plot = rig_trend_plot(rig, trend);
      if (plot)
        gallery.figures.push_back(figure_of(std::move(*plot),
                                            fmt::format("Does {} change?", trend_name(trend)),
                                            trend_sentence(trend)));
    }
    if (!gallery.figures.empty()) {
      any = true;
      section.blocks.emplace_back(doc::Heading{{rig.rig}});
      section.blocks.emplace_back(std::move(gallery));
    } else if (!rig.trends.empty()) {
      section.blocks.emplace_back(
          doc::reading(rig.rig + ": its results have fewer than two dates."));
    }
  }
  doc::Paragraph first{
      {"Estimates against the dates of their records, from earlier results and this one. A line is "
       "drawn if a trend can be tested: at least three dated estimates from different records."}};
  if (!any)
    first.line = {"No rig has an earlier result with dated records: ", doc::Code{"--earlier"},
                  " names folders of earlier batches, and ", doc::Code{"date"},
                  " of a condition its day."};
  section.blocks.insert(section.blocks.begin(), std::move(first));
  return section;
}

}  // namespace

doc::Verdict batch_headline(const StoredBatch& batch) {
  const bool failed = batch.exit_code > 1;
  const bool fails = batch.exit_code == 1;
  const bool warns = std::any_of(batch.rigs.begin(), batch.rigs.end(), [](const StoredRig& rig) {
    return rig.verdict == calib::Verdict::warn;
  });
  const bool judged = std::all_of(batch.rigs.begin(), batch.rigs.end(),
                                  [](const StoredRig& rig) { return rig.verdict.has_value(); });
  const std::string sentence = batch_sentence(batch) + ".";
  doc::Verdict verdict{failed   ? doc::Badge{doc::State::bad, "INCOMPLETE"}
                       : fails  ? doc::Badge{doc::State::bad, "FAIL"}
                       : warns  ? doc::Badge{doc::State::warn, "WARN"}
                       : judged ? doc::Badge{doc::State::good, "PASS"}
                                : doc::Badge{doc::State::none, "DONE"},
                       {sentence}};
  for (const StoredRig& rig : batch.rigs) {
    const std::string link = "rig-" + anchor(rig.rig);
    if (!has_converged(rig) || rig.exit_code > 1)
      add_reason(verdict, fmt::format("{}: {}", rig.rig, rig.message), link);
    for (const std::string& reason : rig.reasons)
      add_reason(verdict, fmt::format("{}: {}", rig.rig, reason), link);
    for (const StoredRigTrend& trend : rig.trends) {
      if (is_significant(trend))
        add_reason(verdict, fmt::format("{}: {}", rig.rig, trend_sentence(trend)), "rig-trends");
    }
  }
  return verdict;
}

std::vector<doc::Section> batch_sections(const StoredBatch& batch) {
  doc::Table table{"One row for each rig"};
  table.style = "rigs";
  table.columns = {{"Rig"},
                   {"Verdict"},
                   {"Worst scores"},
                   {"Estimates"},
                   {"Reasons and warnings", Kind::words},
                   {"Exit", Kind::number},
                   {"Time, s", Kind::number}};
  for (const StoredRig& rig : batch.rigs) table.rows.push_back(rig_row(rig));
  return {{"rigs",
           "Rigs",
           {doc::reading(
                "The three worst scores of each rig (rho2, mean absolute error in percent), its "
                "estimates with 95 % intervals, why it did not pass, and its first warnings."),
            doc::about_picture("The name links to its own report."), std::move(table)}},
          trends_section(batch)};
}

std::vector<Figure> batch_figures(const StoredBatch& batch) {
  std::vector<Figure> figures;
  for (const StoredRig& rig : batch.rigs) {
    for (const StoredRigTrend& trend : rig.trends) {
      auto plot = rig_trend_plot(rig, trend);
      if (plot)
        figures.push_back(
            {plain_name("trend_" + rig.rig + "_" + trend_name(trend)), std::move(*plot)});
    }
  }
  return figures;
}

void add_batch(const StoredBatch& batch, Part& part) {
  part.campaign = batch.folder;
  part.synthetic = std::any_of(batch.rigs.begin(), batch.rigs.end(),
                               [](const StoredRig& rig) { return rig.synthetic; });
}

}  // namespace rigcal::report
