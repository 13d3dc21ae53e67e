#include "report/leak/diagnosis.hpp"

#include "report/store/csv_columns.hpp"
#include "report/store/identity.hpp"

namespace rigcal::report {
namespace {

using diagnosis::RecordDiagnosis;
using diagnosis::StatedLeak;

/// Returns the class found for a record, or a word that explains why there is none.
std::string found_class(const RecordDiagnosis& record) {
  if (!record.failure && record.is_reference) return "reference";
  if (record.leak.compatible_with_model == false) return "incompatible";
  if (record.explained_by_leak == false) return "not explained";
  return record.leak.class_ ? csv_field(record.leak.class_) : "undecided";
}

/// Returns why a record could not be diagnosed, and otherwise its warnings.
std::vector<std::string> warnings_of(const RecordDiagnosis& record) {
  return record.failure ? std::vector{*record.failure} : record.warnings;
}

}  // namespace

StoredDiagnosis stored(const datasets::Campaign& campaign, const diagnosis::Diagnosis& found,
                       const std::vector<std::string>& reasons, const Provenance& provenance) {
  StoredDiagnosis file;
  file.status = leak_status(reasons, found.usable());
  file.reasons = reasons;
  file.campaign = campaign.name;
  file.synthetic = campaign.synthetic;
  file.report = identity_json(campaign);
  file.found = found;
  file.provenance = stored(provenance);
  return file;
}

std::string diagnosis_csv(const StoredDiagnosis& diagnosis) {
  using R = RecordDiagnosis;
  using Features = decltype(R::features);
  CsvColumns<R> columns;
  columns.members(&R::condition, &R::repeat, &R::signal)
      .add("leakage_coefficient", &R::leak, &StatedLeak::leakage_coefficient)
      .add("ci95_low", &R::leak, &StatedLeak::ci95, &Range::low)
      .add("ci95_high", &R::leak, &StatedLeak::ci95, &Range::high)
      .add("leak_share_percent", &R::leak, &StatedLeak::leak_share_percent)
      .add("leak_share_ci95_low_percent", &R::leak, &StatedLeak::leak_share_ci95_percent,
           &Range::low)
      .add("leak_share_ci95_high_percent", &R::leak, &StatedLeak::leak_share_ci95_percent,
           &Range::high)
      .add("leak_flow_l_per_min", &R::leak, &StatedLeak::leak_flow_l_per_min)
      .add("class", found_class);
  for (const datasets::LeakClass each : datasets::kLeakClasses) {
    const std::string name(to_string(each));
    columns.add("probability_" + name, &R::leak, &StatedLeak::class_probabilities,
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
  return text + columns.table(diagnosis.found.records);
}

}  // namespace rigcal::report
