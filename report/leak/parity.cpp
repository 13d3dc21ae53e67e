#include "report/leak/parity.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "report/store/csv_fields.hpp"
#include "report/store/identity.hpp"
#include "report/store/table.hpp"

namespace rigcal::report {
namespace {

using diagnosis::ParityCondition;
using diagnosis::ParityResidual;
using diagnosis::ParitySignal;

const ParitySignal* signal_of(const ParityResult& result, const diagnosis::ParityRecord& record) {
  for (const ParitySignal& signal : result.parity.signals)
    if (signal.signal == record.signal) return &signal;
  return nullptr;
}

std::string repeat_name(const diagnosis::ParityRecord& record) {
  return record.repeat ? fmt::format("{}", *record.repeat) : std::string("mean");
}

std::filesystem::path series_file(const std::string& condition) {
  return std::filesystem::path("parity") / (condition + ".csv");
}

std::string series_csv(const ParityCondition& condition) {
  Table table;
  table.add("time_s", condition.time_s);
  table.add("healthy_model_m", condition.model_m);
  for (const ParityResidual& record : condition.records) {
    if (record.failure) continue;
    const auto add = [&](const char* what, const std::vector<double>& values) {
      table.add(fmt::format("{}_{}_m", what, repeat_name(record)), values);
    };
    add("parity", record.parity_m);
    add("residual", record.residual_m);
    add("moving_rms", record.moving_rms_m);
  }
  return csv_of(table);
}

}  // namespace

LeakStatus status_of(const ParityResult& result) {
  if (!result.reasons.empty()) return LeakStatus::declined;
  return result.parity.usable() ? LeakStatus::done : LeakStatus::failed;
}

StoredParity stored(const ParityResult& result) {
  StoredParity file;
  file.status = status_of(result);
  file.reasons = result.reasons;
  file.campaign = result.campaign.name;
  file.synthetic = result.campaign.synthetic;
  file.report = identity_json(result.campaign);
  file.false_alarm_probability = result.false_alarm;
  file.signals = result.parity.signals;
  for (const ParityCondition& condition : result.parity.conditions)
    file.records.insert(file.records.end(), condition.records.begin(), condition.records.end());
  file.false_alarm_check = result.parity.check;
  file.warnings = result.parity.warnings;
  file.provenance = stored(result.provenance);
  return file;
}

std::string parity_csv(const ParityResult& result) {
  std::string text;
  if (const LeakStatus status = status_of(result); status != LeakStatus::done) {
    text = csv_comment(
               fmt::format("status: {}: {}", to_string(status), fmt::join(result.reasons, "; "))) +
           "\n";
  }
  text += csv_row({"condition", "repeat", "signal", "leak_level", "healthy", "sets_threshold",
                   "peak_m", "threshold_m", "alarm", "time_to_alarm_s", "feature_mean_m",
                   "feature_rms_m", "feature_std_m", "failure"});
  for (const ParityCondition& condition : result.parity.conditions) {
    for (const ParityResidual& record : condition.records) {
      const ParitySignal* signal = signal_of(result, record);
      text += csv_row({csv_text(record.condition), repeat_name(record), csv_text(record.signal),
                       csv_text(record.leak_level.value_or("")), record.healthy ? "1" : "0",
                       record.sets_threshold ? "1" : "0", csv_number(record.peak_m),
                       record.alarm ? csv_number(signal->threshold_m) : "",
                       record.alarm ? (*record.alarm ? "1" : "0") : "",
                       csv_number(record.time_to_alarm_s), csv_number(record.features.mean_m),
                       csv_number(record.features.rms_m), csv_number(record.features.std_m),
                       csv_text(record.failure.value_or(""))});
    }
  }
  return text;
}

PlannedFiles planned_parity(const datasets::Campaign& campaign) {
  PlannedFiles planned{{"parity.json", "parity.csv", "report.html"}, {"parity"}};
  for (const datasets::Condition& condition : campaign.conditions)
    planned.files.push_back(series_file(condition.id));
  return planned;
}

std::vector<ResultFile> parity_series(const ParityResult& result) {
  std::vector<ResultFile> files;
  for (const ParityCondition& condition : result.parity.conditions) {
    if (condition.model_m.empty()) continue;
    files.push_back({series_file(condition.condition), series_csv(condition)});
  }
  return files;
}

}  // namespace rigcal::report
