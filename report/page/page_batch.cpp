#include "report/page/page_batch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/calendar.hpp"
#include "report/batch/batch.hpp"

namespace rigcal::report {
namespace {

/// Warnings of a rig that the overview shows; its own report has all.
constexpr std::size_t kShownWarnings = 3;

/// A relative path as a link: what has a meaning in one is escaped.
std::string as_link(const std::string& path) {
  std::string link;
  for (const char c : path) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '/' || c == '.' || c == '-' || c == '_';
    link += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return link;
}

Json rig_badge(const StoredRig& rig) {
  if (!rig.status) return {{"word", "no result"}, {"mark", "✕"}, {"class", "bad"}};
  if (!has_converged(rig))
    return {{"word", to_string(*rig.status)}, {"mark", "✕"}, {"class", "bad"}};
  return badge(rig.verdict);
}

Json score_views(const StoredRig& rig) {
  Json list = Json::array();
  for (const StoredRigScore& score : rig.worst_scores) {
    list.push_back({{"condition", score.condition},
                    {"channel", score.channel},
                    {"failed", !score.failure.empty()},
                    {"badge", badge(score.verdict)},
                    {"rho2", shown_agreement(score.rho2)},
                    {"error", shown_in(score.absolute_error_percent, 1.0, 3)}});
  }
  return list;
}

Json rig_estimate_views(const StoredRig& rig) {
  Json list = Json::array();
  for (const StoredRigEstimate& each : rig.parameters) {
    const RowUnit unit = row_unit(each.value, each.unit);
    const Json shown = shown_estimate(each.value, each.ci95, unit.si);
    const Json& interval = shown.at("interval");
    list.push_back({{"name", parameter_label(each)},
                    {"unit", unit.name},
                    {"value", shown.at("value")},
                    {"interval", interval.at("known")},
                    {"low", interval.at("low")},
                    {"high", interval.at("high")},
                    {"doubtful", is_doubtful(each.identifiability)},
                    {"grade", grade_words(each.identifiability)}});
  }
  return list;
}

/// Points over days since the first; nothing where fewer than two have a date.
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
  const RowUnit unit = row_unit(largest, trend.unit);
  Trace spans = empty_trace(Trace::Kind::intervals, "model");
  Trace middles = empty_trace(Trace::Kind::points, "model");
  for (const StoredTrendPoint& point : points) {
    if (!point.day || !point.value) continue;
    middles.x.push_back(*point.day - first);
    middles.y.push_back(*point.value / unit.si);
    add_interval(spans, *point.day - first, point.ci95, unit.si);
  }
  Plot plot;
  plot.title = fmt::format("{} of {} over time, with 95 % intervals", trend_name(trend), rig.rig);
  plot.x_label = "days since " + date_of(first);
  plot.y_label = trend_name(trend) + (unit.name.empty() ? "" : fmt::format(" [{}]", unit.name));
  plot.width = 300.0;
  plot.height = 170.0;
  const StoredTrend& along = trend.series.along_date;
  if (along.slope && along.intercept) {
    Trace line = empty_trace(Trace::Kind::line, "reference");
    for (const double day : {first, last}) {
      line.x.push_back(day - first);
      line.y.push_back((*along.intercept + *along.slope * day) / unit.si);
    }
    plot.traces.push_back(std::move(line));
  }
  plot.traces.push_back(std::move(spans));
  plot.traces.push_back(std::move(middles));
  return plot;
}

Json trend_views_of(const StoredRig& rig) {
  Json list = Json::array();
  for (const StoredRigTrend& trend : rig.trends) {
    const auto plot = rig_trend_plot(rig, trend);
    if (plot) list.push_back({{"svg_html", svg(*plot)}, {"reading", trend_sentence(trend)}});
  }
  return list;
}

Json rig_view(const StoredRig& rig) {
  Json warnings = Json::array();
  for (std::size_t i = 0; i < std::min(rig.warnings.size(), kShownWarnings); ++i)
    warnings.push_back(rig.warnings[i]);
  const bool troubled = !has_converged(rig) || rig.exit_code > 1;
  Json trends = trend_views_of(rig);
  const bool undated = trends.empty() && !rig.trends.empty();
  return {{"rig", rig.rig},
          {"anchor", anchor(rig.rig)},
          {"name", rig.name.value_or("")},
          {"link", as_link(rig.folder + "/report.html")},
          {"has_report", rig.has_report},
          {"badge", rig_badge(rig)},
          {"exit_code", fmt::format("{}", rig.exit_code)},
          {"unchanged", rig.unchanged},
          {"seconds", shown_in(rig.seconds, 1.0, 3)},
          {"message", rig.message},
          {"troubled", troubled},
          {"reasons", rig.reasons},
          {"scores", score_views(rig)},
          {"parameters", rig_estimate_views(rig)},
          {"warnings", std::move(warnings)},
          {"warning_count", fmt::format("{}", rig.warnings.size())},
          {"more_warnings", rig.warnings.size() > kShownWarnings},
          {"has_trends", !trends.empty()},
          {"undated", undated},
          {"trends", std::move(trends)}};
}

}  // namespace

Json batch_headline(const StoredBatch& batch) {
  const bool failed = batch.exit_code > 1;
  const bool fails = batch.exit_code == 1;
  const bool warns = std::any_of(batch.rigs.begin(), batch.rigs.end(), [](const StoredRig& rig) {
    return rig.verdict == calib::Verdict::warn;
  });
  const bool judged = std::all_of(batch.rigs.begin(), batch.rigs.end(),
                                  [](const StoredRig& rig) { return rig.verdict.has_value(); });
  const std::string sentence = batch_sentence(batch) + ".";
  Json view = failed   ? make_headline("INCOMPLETE", "✕", "bad", sentence)
              : fails  ? make_headline("FAIL", "✕", "bad", sentence)
              : warns  ? make_headline("WARN", "!", "warn", sentence)
              : judged ? make_headline("PASS", "✓", "good", sentence)
                       : make_headline("DONE", "○", "none", sentence);
  for (const StoredRig& rig : batch.rigs) {
    const std::string link = "rig-" + anchor(rig.rig);
    if (!has_converged(rig) || rig.exit_code > 1)
      add_reason(view, fmt::format("{}: {}", rig.rig, rig.message), link);
    for (const std::string& reason : rig.reasons)
      add_reason(view, fmt::format("{}: {}", rig.rig, reason), link);
    for (const StoredRigTrend& trend : rig.trends) {
      if (is_significant(trend))
        add_reason(view, fmt::format("{}: {}", rig.rig, trend_sentence(trend)), "rig-trends");
    }
  }
  return view;
}

Json batch_view(const StoredBatch& batch) {
  Json view;
  view["folder"] = batch.folder;
  view["rigs"] = Json::array();
  bool any_trend = false;
  for (const StoredRig& rig : batch.rigs) {
    view["rigs"].push_back(rig_view(rig));
    any_trend = any_trend || view["rigs"].back().at("has_trends").get<bool>();
  }
  view["has_any_trend"] = any_trend;
  return view;
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

StoredBatch load_batch(const ReadFile& read, const std::string& where) {
  return load<StoredBatch>(read, where, "batch.json");
}

void add_batch(const StoredBatch& batch, Part& part) {
  part.campaign = batch.folder;
  part.synthetic = std::any_of(batch.rigs.begin(), batch.rigs.end(),
                               [](const StoredRig& rig) { return rig.synthetic; });
  part.nav.emplace_back("rig-trends", "Trends");
}

}  // namespace rigcal::report
