#include <fmt/format.h>

#include <algorithm>

#include "report/figure/decimate.hpp"
#include "report/page/page_parts.hpp"

namespace rigcal::report {
namespace {

using doc::Line;
using Kind = doc::Column::Kind;

constexpr double kMillimetres = 1e3;
constexpr std::size_t kPoints = 1200;  ///< number of points on one line of a picture
constexpr int kLengthDigits = 3;

const diagnosis::ParitySignal* signal_of(const StoredParity& parity, const std::string& name) {
  for (const diagnosis::ParitySignal& signal : parity.signals)
    if (signal.signal == name) return &signal;
  return nullptr;
}

/// Summary over the repeats of one condition.
struct Summary {
  std::string condition, level;
  const diagnosis::ParitySignal* signal = nullptr;
  std::optional<double> threshold_m;  ///< threshold for records from the same day
  bool healthy = false;
  bool reference = false;  ///< its records were used to set the threshold
  int judged = 0;
  int alarms = 0;
  std::optional<double> first_s;
  double largest_m = 0.0;
  std::string failure;
};

std::vector<Summary> summaries(const StoredParity& parity) {
  std::vector<Summary> list;
  for (const diagnosis::ParityRecord& record : parity.records) {
    if (list.empty() || list.back().condition != record.condition) {
      Summary& fresh = list.emplace_back();
      fresh.condition = record.condition;
      fresh.level = record.leak_level.value_or("");
      fresh.signal = signal_of(parity, record.signal);
      if (fresh.signal != nullptr) fresh.threshold_m = fresh.signal->threshold_m;
      fresh.healthy = record.healthy;
    }
    Summary& own = list.back();
    if (record.failure) own.failure = *record.failure;
    if (record.threshold_m) own.threshold_m = *record.threshold_m;
    own.reference = own.reference || record.sets_threshold;
    own.largest_m = std::max(own.largest_m, record.peak_m.value_or(0.0));
    if (!record.alarm) continue;
    ++own.judged;
    if (!*record.alarm) continue;
    ++own.alarms;
    const double at_s = record.time_to_alarm_s.value_or(0.0);
    own.first_s = std::min(own.first_s.value_or(at_s), at_s);
  }
  return list;
}

doc::Badge alarm_badge(const Summary& summary) {
  if (summary.judged == 0 && summary.reference && summary.failure.empty())
    return {doc::State::none, "reference"};
  if (summary.judged == 0)
    return {doc::State::none, summary.failure.empty() ? "not judged" : "failed"};
  if (summary.alarms == 0) return {doc::State::good, "no alarm"};
  return {doc::State::warn, fmt::format("alarm in {} of {}", summary.alarms, summary.judged)};
}

std::vector<double> in_millimetres(const std::vector<double>& metres) {
  std::vector<double> result = metres;
  for (double& value : result) value *= kMillimetres;
  return result;
}

/// Adds the columns of all repeats whose name starts with `column`, thinned for drawing.
void add_lines(const Table& series, const std::string& column, const char* style, const char* name,
               Plot& plot) {
  const std::vector<double>* time = series.find("time_s");
  if (time == nullptr) return;
  const Buckets thin = buckets(time->size(), kPoints);
  for (const auto& title : series.names) {
    if (title.rfind(column + "_", 0) != 0) continue;
    Trace line = empty_trace(Trace::Kind::line, style, plot.traces.empty() ? name : "");
    line.x = thinned_times(*time, *series.find(title), thin);
    line.y = thinned(in_millimetres(*series.find(title)), thin);
    plot.traces.push_back(std::move(line));
  }
}

Plot residual_plot(const Summary& summary, const Table& series) {
  Plot plot{fmt::format("Parity residual of {}, all repeats", summary.condition), "time [s]",
            "residual [mm]"};
  add_lines(series, "residual", "residual", "each repeat", plot);
  return plot;
}

Plot alarm_plot(const Summary& summary, const Table& series) {
  Plot plot{fmt::format("Moving root mean square of {}, all repeats, and its threshold",
                        summary.condition),
            "time [s]", "moving rms [mm]"};
  plot.height = 160.0;
  add_lines(series, "moving_rms", "model", "each repeat", plot);
  if (summary.threshold_m) plot.levels.push_back(kMillimetres * *summary.threshold_m);
  return plot;
}

std::string sentence_of(const StoredParity& parity, const std::vector<Summary>& list) {
  if (parity.status == LeakStatus::declined) return "These records have no parity residual.";
  if (parity.status == LeakStatus::failed)
    return "No parity residual could be computed: do not use anything below.";
  int judged = 0;
  int alarmed = 0;
  for (const Summary& each : list) {
    judged += each.judged > 0 ? 1 : 0;
    alarmed += each.alarms > 0 ? 1 : 0;
  }
  if (judged == 0) return "Nothing could be judged: no signal has enough healthy records.";
  return fmt::format(
      "{} of {} conditions raise an alarm (threshold: {:g} % false alarms per healthy "
      "record).",
      alarmed, judged, 100.0 * parity.false_alarm_probability);
}

std::string check_sentence(const diagnosis::FalseAlarmCheck& check) {
  if (check.records == 0)
    return "The rate of false alarms is unverified: all healthy records were used to set the "
           "thresholds.";
  return fmt::format(
      "Of {} healthy records that set no threshold {} raise{} an alarm ({:.3g} expected).",
      check.records, check.alarms, check.alarms == 1 ? "s" : "", check.expected);
}

}  // namespace

doc::Verdict parity_headline(const ParityFiles& stored) {
  const StoredParity& parity = stored.result;
  const auto list = summaries(parity);
  const std::string sentence = sentence_of(parity, list);
  if (parity.status != LeakStatus::done)
    return verdict_without_result(parity.status, sentence, parity.reasons, "parity");
  const bool judged =
      std::any_of(list.begin(), list.end(), [](const Summary& each) { return each.judged > 0; });
  const bool alarm =
      std::any_of(list.begin(), list.end(), [](const Summary& each) { return each.alarms > 0; });
  doc::Verdict verdict{!judged ? doc::Badge{doc::State::none, "NOT JUDGED"}
                       : alarm ? doc::Badge{doc::State::warn, "ALARM"}
                               : doc::Badge{doc::State::good, "NO ALARM"},
                       {sentence}};
  for (const Summary& each : list) {
    if (each.alarms == 0) continue;
    add_reason(verdict,
               fmt::format("{}: alarm in {} of {} records, after {:.3g} s", each.condition,
                           each.alarms, each.judged, *each.first_s),
               "parity");
  }
  return verdict;
}

std::vector<Figure> parity_figures(const ParityFiles& stored) {
  std::vector<Figure> figures;
  for (const Summary& each : summaries(stored.result)) {
    const auto series = stored.series.find(each.condition);
    if (series == stored.series.end()) continue;
    figures.push_back({each.condition + "_parity", residual_plot(each, *series->second)});
    figures.push_back({each.condition + "_alarm", alarm_plot(each, *series->second)});
  }
  return figures;
}

namespace {

Line millimetres(const std::optional<double>& metres) {
  return {doc::in_unit(metres, 1.0 / kMillimetres, kLengthDigits)};
}

doc::Table alarm_table(const std::vector<Summary>& list) {
  doc::Table table{"Alarms of each condition"};
  table.caption = {table.label};
  table.columns = {{"Condition"},
                   {"Leak level"},
                   {"Alarm"},
                   {"Largest moving rms, mm", Kind::number},
                   {"Threshold, mm", Kind::number},
                   {"First alarm, s", Kind::number}};
  for (const Summary& each : list) {
    Line level{each.level};
    if (each.healthy) level.emplace_back(doc::Soft{" healthy"});
    doc::Row row{{each.condition,
                  {std::move(level)},
                  alarm_badge(each),
                  {millimetres(each.largest_m)},
                  {millimetres(each.threshold_m)},
                  doc::in_unit(each.first_s, 1.0, kLengthDigits)}};
    if (!each.failure.empty()) row.notes = {each.failure};
    table.rows.push_back(std::move(row));
  }
  return table;
}

doc::Table threshold_table(const std::vector<diagnosis::ParitySignal>& signals) {
  doc::Table table{"Thresholds of each signal"};
  table.caption = {"Thresholds of each signal, mm"};
  table.columns = {{"Signal"},
                   {"Window, s", Kind::number},
                   {"Healthy records", Kind::number},
                   {"Moving rms", Kind::number},
                   {"Mean of |r|", Kind::number},
                   {"rms", Kind::number},
                   {"Standard deviation of |r|", Kind::number},
                   {"Note"}};
  for (const diagnosis::ParitySignal& signal : signals)
    table.rows.push_back({{signal.signal,
                           doc::in_unit(signal.window_s, 1.0, kLengthDigits),
                           fmt::format("{}", signal.healthy_records),
                           {millimetres(signal.threshold_m)},
                           {millimetres(signal.feature_thresholds.mean_m)},
                           {millimetres(signal.feature_thresholds.rms_m)},
                           {millimetres(signal.feature_thresholds.std_m)},
                           signal.reason.value_or("")}});
  return table;
}

}  // namespace

std::vector<doc::Section> parity_sections(const ParityFiles& stored) {
  const StoredParity& parity = stored.result;
  const auto list = summaries(parity);
  doc::Section section{"parity", "Parity residual"};
  doc::Blocks& blocks = section.blocks;
  if (parity.status != LeakStatus::done)
    blocks.emplace_back(list_of(parity.reasons, doc::State::warn));
  if (list.empty()) return {std::move(section)};
  blocks.emplace_back(doc::reading(fmt::format(
      "Measured position minus that of the healthy model with the same reference, minus the mean "
      "of this difference over healthy records. Alarm: its moving rms exceeds the threshold, which "
      "happens in a healthy record with a probability of {:g} %. {}",
      100.0 * parity.false_alarm_probability, check_sentence(parity.false_alarm_check))));
  blocks.emplace_back(alarm_table(list));
  blocks.emplace_back(threshold_table(parity.signals));
  if (!parity.warnings.empty()) {
    blocks.emplace_back(doc::Heading{{"Warnings"}});
    blocks.emplace_back(list_of(parity.warnings, doc::State::warn));
  }
  for (const Summary& each : list) {
    const auto series = stored.series.find(each.condition);
    if (series == stored.series.end()) continue;
    blocks.emplace_back(doc::Heading{{each.condition + " ", alarm_badge(each)}});
    blocks.emplace_back(figure_of(residual_plot(each, *series->second)));
    blocks.emplace_back(figure_of(alarm_plot(each, *series->second)));
  }
  return {std::move(section)};
}

}  // namespace rigcal::report
