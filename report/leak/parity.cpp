#include "report/leak/parity.hpp"

#include <fmt/format.h>

#include "report/store/csv_columns.hpp"
#include "report/store/identity.hpp"
#include "report/store/result_files.hpp"

namespace rigcal::report {
namespace {

using diagnosis::ParityCondition;
using diagnosis::ParityResidual;
using diagnosis::ParitySignal;

std::string repeat_name(const std::optional<int>& repeat) {
  return repeat ? fmt::format("{}", *repeat) : "mean";
}

std::filesystem::path series_file(const std::string& condition) {
  return std::filesystem::path("parity") / (condition + ".csv");
}

Table series_of(const ParityCondition& condition) {
  Table table;
  table.add("time_s", condition.time_s);
  table.add("healthy_model_m", condition.model_m);
  for (const ParityResidual& record : condition.records) {
    if (record.failure) continue;
    const auto add = [&](const char* what, const std::vector<double>& values) {
      table.add(fmt::format("{}_{}_m", what, repeat_name(record.repeat)), values);
    };
    add("parity", record.parity_m);
    add("residual", record.residual_m);
    add("moving_rms", record.moving_rms_m);
  }
  return table;
}

}  // namespace

StoredParity stored(const datasets::Campaign& campaign, const diagnosis::Parity& parity,
                    const std::vector<std::string>& reasons, double false_alarm,
                    const Provenance& provenance) {
  StoredParity file;
  file.status = leak_status(reasons, parity.usable());
  file.reasons = reasons;
  file.campaign = campaign.name;
  file.synthetic = campaign.synthetic;
  file.report = identity_json(campaign);
  file.false_alarm_probability = false_alarm;
  file.signals = parity.signals;
  for (const ParityCondition& condition : parity.conditions)
    file.records.insert(file.records.end(), condition.records.begin(), condition.records.end());
  file.false_alarm_check = parity.check;
  file.warnings = parity.warnings;
  file.provenance = stored(provenance);
  return file;
}

std::string parity_csv(const StoredParity& parity) {
  using R = decltype(StoredParity::records)::value_type;
  using Features = decltype(R::features);
  // A result of an earlier version states the threshold of the signal alone.
  const auto threshold_m = [&](const R& record) -> std::optional<double> {
    if (!record.alarm) return std::nullopt;
    if (record.threshold_m) return record.threshold_m;
    for (const ParitySignal& signal : parity.signals)
      if (signal.signal == record.signal) return signal.threshold_m;
    return std::nullopt;
  };
  CsvColumns<R> columns;
  columns.members(&R::condition)
      .add("repeat", [](const R& record) { return repeat_name(record.repeat); })
      .members(&R::signal, &R::leak_level, &R::healthy, &R::sets_threshold, &R::peak_m)
      .add("threshold_m", threshold_m)
      .members(&R::alarm, &R::time_to_alarm_s)
      .add("feature_mean_m", &R::features, &Features::mean_m)
      .add("feature_rms_m", &R::features, &Features::rms_m)
      .add("feature_std_m", &R::features, &Features::std_m)
      .members(&R::failure);
  std::string text;
  if (parity.status != LeakStatus::done)
    text = csv_status(to_string(parity.status), parity.reasons);
  return text + columns.table(parity.records);
}

PlannedFiles planned_parity(const datasets::Campaign& campaign) {
  PlannedFiles planned{{"parity.json", "parity.csv", "report.html"}, {"parity"}};
  for (const datasets::Condition& condition : campaign.conditions)
    planned.files.push_back(series_file(condition.id));
  return planned;
}

std::vector<ResultFile> parity_series(const diagnosis::Parity& parity) {
  std::vector<ResultFile> files;
  for (const ParityCondition& condition : parity.conditions) {
    if (condition.model_m.empty()) continue;
    files.push_back(table_file(series_file(condition.condition), series_of(condition)));
  }
  return files;
}

}  // namespace rigcal::report
