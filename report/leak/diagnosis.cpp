#include "report/leak/diagnosis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "diagnosis/signal_name.hpp"
#include "report/leak/leak_estimate.hpp"
#include "report/leak/leak_trend.hpp"
#include "report/leak/machine_state.hpp"
#include "report/store/csv_fields.hpp"

namespace rigcal::report {
namespace {

using datasets::LeakClass;
using diagnosis::RecordDiagnosis;

std::string number_field(bool is_there, double value) {
  return is_there && std::isfinite(value) ? fmt::format("{}", value) : std::string();
}

std::string class_name(const std::optional<LeakClass>& leak_class, const char* otherwise = "") {
  return leak_class ? std::string(to_string(*leak_class)) : otherwise;
}

/// Returns the class found for a record, or a word that explains why there is none.
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
                                  number_field(has_interval, e.ci95.low),
                                  number_field(has_interval, e.ci95.high),
                                  number_field(has_share, kInPercent * e.share),
                                  number_field(has_share, kInPercent * e.share_ci95.low),
                                  number_field(has_share, kInPercent * e.share_ci95.high),
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

}  // namespace rigcal::report
