#include "report/leak/diagnosis.hpp"

#include "diagnosis/signal_name.hpp"
#include "report/store/csv_columns.hpp"

namespace rigcal::report {
namespace {

/// Returns the class found for a record, or a word that explains why there is none.
std::string found_class(const StoredDiagnosedRecord& record) {
  if (!record.failure && record.is_reference) return "reference";
  if (record.leak.compatible_with_model == false) return "incompatible";
  if (record.explained_by_leak == false) return "not explained";
  return record.leak.class_ ? csv_field(record.leak.class_) : "undecided";
}

/// Returns why a record could not be diagnosed, and otherwise its warnings.
std::vector<std::string> warnings_of(const StoredDiagnosedRecord& record) {
  return record.failure ? std::vector{*record.failure} : record.warnings;
}

}  // namespace

LeakStatus status_of(const DiagnosisResult& result) {
  if (!result.reasons.empty()) return LeakStatus::declined;
  return result.diagnosis.usable() ? LeakStatus::done : LeakStatus::failed;
}

std::string drive_of(const datasets::Campaign& campaign, const calib::LeakDrive& drive) {
  datasets::Condition condition;
  condition.waveform = drive.waveform;
  condition.frequency_hz = drive.frequency_hz;
  condition.amplitude = drive.amplitude();
  return diagnosis::signal_name(campaign, condition);
}

std::string diagnosis_csv(const StoredDiagnosis& diagnosis) {
  using R = StoredDiagnosedRecord;
  using Features = decltype(R::features);
  CsvColumns<R> columns;
  columns.members(&R::condition, &R::repeat, &R::signal)
      .add("leakage_coefficient", &R::leak, &StoredLeak::leakage_coefficient)
      .add("ci95_low", &R::leak, &StoredLeak::ci95, &Range::low)
      .add("ci95_high", &R::leak, &StoredLeak::ci95, &Range::high)
      .add("leak_share_percent", &R::leak, &StoredLeak::leak_share_percent)
      .add("leak_share_ci95_low_percent", &R::leak, &StoredLeak::leak_share_ci95_percent,
           &Range::low)
      .add("leak_share_ci95_high_percent", &R::leak, &StoredLeak::leak_share_ci95_percent,
           &Range::high)
      .add("leak_flow_l_per_min", &R::leak, &StoredLeak::leak_flow_l_per_min)
      .add("class", found_class);
  for (const datasets::LeakClass each : datasets::kLeakClasses) {
    const std::string name(to_string(each));
    columns.add("probability_" + name, &R::leak, &StoredLeak::class_probabilities,
                [name](const auto& of_class) { return find(of_class, name); });
  }
  columns.add("feature_mean_m", &R::features, &Features::mean_m)
      .add("feature_rms_m", &R::features, &Features::rms_m)
      .add("feature_std_m", &R::features, &Features::std_m)
      .members(&R::class_by_features, &R::true_class, &R::true_share_percent)
      .add("warnings", warnings_of);
  std::string text;
  if (diagnosis.status != LeakStatus::done)
    text = csv_status(to_string(diagnosis.status), diagnosis.reasons);
  return text + columns.table(diagnosis.records);
}

}  // namespace rigcal::report
