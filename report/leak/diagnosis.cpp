#include "report/leak/diagnosis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>

#include "diagnosis/signal_name.hpp"
#include "report/leak/leak_estimate.hpp"
#include "report/leak/leak_trend.hpp"
#include "report/leak/machine_state.hpp"
#include "report/store/csv_fields.hpp"
#include "report/text/gathered_warnings.hpp"
#include "report/text/text_table.hpp"

namespace rigcal::report {
namespace {

using datasets::LeakClass;
using diagnosis::Accuracy;
using diagnosis::DetectionLimit;
using diagnosis::RecordDiagnosis;
using diagnosis::SignalDiagnosis;
using Align = TextTable::Align;

constexpr std::size_t kSentenceColumns = 80;  ///< sentences read better so, whatever the terminal

std::string number_field(bool is_there, double value) {
  return is_there && std::isfinite(value) ? fmt::format("{}", value) : std::string();
}

std::string class_name(const std::optional<LeakClass>& leak_class, const char* otherwise = "") {
  return leak_class ? std::string(to_string(*leak_class)) : otherwise;
}

/// Class of a record, or a word for a record without one.
std::string found_class(const RecordDiagnosis& record) {
  if (record.is_reference) return "reference";
  if (record.estimate.incompatible) return "incompatible";
  if (record.unexplained) return "not explained";
  return class_name(record.leak_class, "undecided");
}

std::string record_row(const RecordDiagnosis& record) {
  const bool ok = record.fit.ok();
  const diagnosis::LeakEstimate& e = record.estimate;
  const bool has_leak = ok && !record.is_reference && !e.incompatible;
  const bool has_interval = has_leak && e.standard_error > 0.0;
  const bool has_share = has_leak && e.has_share();
  std::vector<std::string> fields{record.condition,
                                  record.repeat ? fmt::format("{}", *record.repeat) : std::string(),
                                  csv_text(record.signal),
                                  number_field(has_leak, std::max(0.0, e.coefficient)),
                                  number_field(has_interval, e.ci95.first),
                                  number_field(has_interval, e.ci95.second),
                                  number_field(has_share, kInPercent * e.share),
                                  number_field(has_share, kInPercent * e.share_ci95.first),
                                  number_field(has_share, kInPercent * e.share_ci95.second),
                                  number_field(has_leak, kLitresPerMinute * e.leak_flow_m3_per_s),
                                  ok ? found_class(record) : class_name({}, "undecided")};
  for (const double probability : e.probability)
    fields.push_back(number_field(has_share, probability));
  fields.insert(
      fields.end(),
      {number_field(ok, record.features.mean), number_field(ok, record.features.rms),
       number_field(ok, record.features.std), class_name(record.by_features),
       class_name(record.truth),
       number_field(record.true_share.has_value(), kInPercent * record.true_share.value_or(0.0)),
       csv_text(ok ? fmt::format("{}", fmt::join(record.warnings, "; ")) : record.fit.failure)});
  return fmt::format("{}\n", fmt::join(fields, ","));
}

std::string in_colour(const std::string& text, const char* code, const Style& style) {
  return style.colour ? fmt::format("\x1b[{}m{}\x1b[0m", code, text) : text;
}

std::string record_table(const diagnosis::Diagnosis& found, const Style& style) {
  TextTable table({{"condition"},
                   {"repeats", Align::right},
                   {"C_leak", Align::right},
                   {"95 % interval", Align::right},
                   {"share %", Align::right},
                   {"95 % interval", Align::right},
                   {"leak L/min", Align::right, 2},
                   {"class"},
                   {"probability", Align::right, 1},
                   {"by features", Align::left, 3},
                   {"known class"}});
  for (const RecordDiagnosis& record : found.records) {
    if (record.repeat) continue;
    const diagnosis::LeakEstimate& e = record.estimate;
    if (!record.fit.ok()) {
      table.add({record.condition, fmt::format("{}", record.repeats), "-", "-", "-", "-", "-",
                 "not fitted", "-", "-", class_name(record.truth, "-")});
      continue;
    }
    const std::string repeats = fmt::format("{}", record.repeats);
    if (record.is_reference || e.incompatible) {
      table.add({record.condition, repeats, "-", "-", "-", "-", "-", found_class(record), "-",
                 class_name(record.by_features, "-"), class_name(record.truth, "-")});
      continue;
    }
    const double best = e.probability[static_cast<std::size_t>(e.most_probable)];
    const bool has_share = e.has_share();
    table.add({record.condition, repeats, fmt::format("{:.4g}", std::max(0.0, e.coefficient)),
               e.standard_error > 0.0 ? fmt::format("{:.3g} .. {:.3g}", e.ci95.first, e.ci95.second)
                                      : "-",
               has_share ? fmt::format("{:.2f}", kInPercent * e.share) : "-",
               has_share ? fmt::format("{:.2f} .. {:.2f}", kInPercent * e.share_ci95.first,
                                       kInPercent * e.share_ci95.second)
                         : "-",
               fmt::format("{:.4f}", kLitresPerMinute * e.leak_flow_m3_per_s), found_class(record),
               has_share ? fmt::format("{:.3f}", best) : "-", class_name(record.by_features, "-"),
               class_name(record.truth, "-")});
  }
  return table.text(style.columns);
}

std::string accuracy_table(const diagnosis::Diagnosis& found, const Style& style) {
  TextTable table({{"method"},
                   {"records"},
                   {"right", Align::right},
                   {"accuracy %", Align::right},
                   {"95 % (Wilson, over conditions)", Align::right},
                   {"undecided", Align::right},
                   {"off by two", Align::right}});
  const auto add = [&](const char* method, const char* records, const Accuracy& accuracy) {
    if (accuracy.records == 0) return;
    table.add({method, records, fmt::format("{} of {}", accuracy.right, accuracy.records),
               fmt::format("{:.1f}", kInPercent * accuracy.accuracy),
               fmt::format("{:.1f} .. {:.1f}", kInPercent * accuracy.ci95.first,
                           kInPercent * accuracy.ci95.second),
               fmt::format("{}", accuracy.undecided), fmt::format("{}", accuracy.off_by_two)});
  };
  add("fitted leak", "single repeats", found.single);
  add("fitted leak", "averages", found.averaged);
  add("paper's features, without this repeat", "single repeats", found.features);
  add("paper's features, without this signal", "single repeats", found.features_of_other_signals);
  return table.empty() ? std::string() : table.text(style.columns);
}

std::string limit_table(const diagnosis::Diagnosis& found, const Style& style) {
  TextTable table({{"signal"},
                   {"single, L/min", Align::right},
                   {"averaged, L/min", Align::right},
                   {"averaged, share %", Align::right}});
  const auto flow = [](const std::optional<DetectionLimit>& limit) {
    return limit ? fmt::format("{:.4f}", kLitresPerMinute * limit->leak_flow_m3_per_s) : "-";
  };
  for (const SignalDiagnosis& signal : found.signals) {
    table.add({signal.signal, flow(signal.smallest_single_leak), flow(signal.smallest_leak),
               signal.smallest_leak
                   ? fmt::format("{:.2f}", kInPercent * signal.smallest_leak->share)
                   : signal.reason});
  }
  return table.empty() ? std::string() : table.text(style.columns);
}

/// Per signal the coefficient at which each class ends: the column of a leak table.
std::string class_limit_table(const DiagnosisResult& result, const Style& style) {
  std::vector<std::string> signals;
  std::map<std::string, std::map<double, std::string>> cells;
  std::map<double, std::string> heads;
  for (const TableLimit& limit : result.class_limits) {
    const auto ends = class_ending_at(result.campaign.diagnosis, limit.target_percent);
    if (!ends) continue;
    const std::string signal = drive_of(result.campaign, limit);
    if (!cells.contains(signal)) signals.push_back(signal);
    heads[limit.target_percent] =
        fmt::format("{} to {:g} %", to_string(*ends), limit.target_percent);
    std::string cell;
    for (std::size_t i = 0; i < limit.coefficients.size(); ++i) {
      cell += fmt::format("{}{:.3g}", cell.empty() ? "" : ", ", limit.coefficients[i]);
      if (const auto& range = limit.ranges_95[i])
        cell += fmt::format(" ({:.4g} .. {:.4g})", range->low, range->high);
    }
    cells[signal][limit.target_percent] = cell;
  }
  std::vector<TextTable::Column> columns{{"signal"}};
  for (const auto& [percent, head] : heads) columns.push_back({head, Align::right});
  TextTable table(columns);
  for (const std::string& signal : signals) {
    std::vector<std::string> row{signal};
    for (const auto& [percent, head] : heads)
      row.push_back(cells[signal][percent].empty() ? "-" : cells[signal][percent]);
    table.add(row);
  }
  return table.empty() ? std::string() : table.text(style.columns);
}

/// Failures, then the warnings of averages, of repeats that no leak explains, and of all.
std::string warning_lines(const diagnosis::Diagnosis& found) {
  std::vector<std::pair<std::string, std::string>> told;
  for (const RecordDiagnosis& record : found.records) {
    const std::string name = record.repeat
                                 ? fmt::format("{} repeat {}", record.condition, *record.repeat)
                                 : record.condition;
    if (!record.fit.ok()) told.emplace_back(name, record.fit.failure);
    if (record.repeat && !record.unexplained) continue;  // the table files name them all
    for (const std::string& warning : record.warnings) told.emplace_back(name, warning);
  }
  std::string text;
  for (const std::string& line : gathered_by_text(told)) text += fmt::format("  {}\n", line);
  for (const std::string& warning : found.warnings) text += fmt::format("warning: {}\n", warning);
  return text;
}

}  // namespace

LeakStatus status_of(const DiagnosisResult& result) {
  if (!result.reasons.empty()) return LeakStatus::declined;
  return result.diagnosis.usable() ? LeakStatus::done : LeakStatus::failed;
}

std::string drive_of(const datasets::Campaign& campaign, const TableLimit& limit) {
  datasets::Condition condition;
  condition.waveform = limit.waveform;
  condition.frequency_hz = limit.frequency_hz;
  condition.amplitude = limit.amplitude;
  return diagnosis::signal_name(campaign, condition);
}

std::string diagnosis_csv(const DiagnosisResult& result) {
  std::string text;
  if (const LeakStatus status = status_of(result); status != LeakStatus::done) {
    text = fmt::format("# status: {}: {}\n", to_string(status), fmt::join(result.reasons, "; "));
  }
  text +=
      "condition,repeat,signal,leakage_coefficient,ci95_low,ci95_high,leak_share_percent,"
      "leak_share_ci95_low_percent,leak_share_ci95_high_percent,leak_flow_l_per_min,class";
  for (const LeakClass each : datasets::kLeakClasses)
    text += fmt::format(",probability_{}", to_string(each));
  text +=
      ",feature_mean_m,feature_rms_m,feature_std_m,class_by_features,true_class,"
      "true_share_percent,warnings\n";
  for (const RecordDiagnosis& record : result.diagnosis.records) text += record_row(record);
  return text;
}

std::string diagnosis_text(const DiagnosisResult& result, const Style& style) {
  const diagnosis::Diagnosis& found = result.diagnosis;
  const LeakStatus status = status_of(result);
  if (status == LeakStatus::declined) {
    std::string text = in_colour("declined: these records cannot be diagnosed", "31", style) + "\n";
    for (const std::string& reason : result.reasons) text += fmt::format("  - {}\n", reason);
    return text;
  }
  std::string text = in_colour("State of the machine", "1", style) + "\n";
  for (const diagnosis::MachineState& state : found.states)
    text += wrapped("  " + state_sentence(state), kSentenceColumns, 4) + "\n";
  for (const diagnosis::LeakTrend& trend : found.trends)
    text += wrapped("  " + trend_sentence(trend), kSentenceColumns, 4) + "\n";
  text += "\n" + in_colour("Leak in the average of each condition", "1", style) + "\n" +
          record_table(found, style);
  if (const std::string table = accuracy_table(found, style); !table.empty()) {
    text += "\n" + in_colour("Against the known classes (undecided counts as wrong)", "1", style) +
            "\n" + table;
  }
  if (const std::string table = class_limit_table(result, style); !table.empty())
    text += "\n" +
            in_colour("Coefficient at which each class ends, by the leak table", "1", style) +
            "\n" + table;
  if (const std::string table = limit_table(found, style); !table.empty()) {
    const datasets::DiagnosisSettings& settings = result.campaign.diagnosis;
    text +=
        "\n" +
        in_colour(fmt::format("Smallest leak told from none ({:g} % false alarms, found in "
                              "{:g} %)",
                              kInPercent * settings.false_alarms, kInPercent * settings.detection),
                  "1", style) +
        "\n" + table;
  }
  text +=
      "\nstatus: " +
      in_colour(std::string(to_string(status)), status == LeakStatus::done ? "32" : "31", style) +
      "\n";
  text += warning_lines(found);
  if (result.campaign.synthetic) text += "note: the records of this campaign are synthetic\n";
  return text;
}

}  // namespace rigcal::report
