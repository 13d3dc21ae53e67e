#include <array>
#include <cmath>

#include "report/leak/diagnosis.hpp"
#include "report/leak/leak_estimate.hpp"
#include "report/leak/leak_trend.hpp"
#include "report/leak/machine_state.hpp"
#include "report/store/identity.hpp"

namespace rigcal::report {
namespace {

StoredDiagnosedRecord stored(const diagnosis::RecordDiagnosis& record) {
  const bool ok = record.fit.ok();
  const diagnosis::LeakEstimate& e = record.estimate;
  const auto value = [&](double x) { return ok ? std::optional(x) : std::nullopt; };
  StoredDiagnosedRecord told;
  told.condition = record.condition;
  told.repeat = record.repeat;
  told.repeats_averaged = record.repeats;
  told.signal = record.signal;
  told.reference_repeats = record.reference_repeats;
  told.is_reference = record.is_reference;
  if (!ok) told.failure = record.fit.failure;
  const bool judged = ok && !record.is_reference;
  told.leak = report::stored(e, record.leak_class, judged);
  if (judged) told.unbounded_leakage_coefficient = e.coefficient;
  told.undecided = !record.leak_class && !record.is_reference && !e.incompatible;
  if (judged) told.explained_by_leak = !record.unexplained;
  told.features = {value(record.features.mean), value(record.features.rms),
                   value(record.features.std)};
  told.parity_rms_m = value(record.fit.parity_rms_m);
  told.misfit_rms_m = value(record.fit.misfit_rms_m);
  told.noise_rms_m = value(record.fit.noise_rms_m);
  if (judged && e.has_class() && e.share > 0.0)
    told.log_slope = e.share_slope * e.coefficient / e.share;
  told.class_by_features = record.by_features;
  told.class_by_features_of_other_signals = record.by_features_of_other_signals;
  told.true_class = record.truth;
  if (record.true_share) told.true_share_percent = kInPercent * *record.true_share;
  told.warnings = record.warnings;
  return told;
}

StoredSmallestLeak stored(const diagnosis::SignalDiagnosis& signal) {
  const auto flow = [](const std::optional<diagnosis::DetectionLimit>& limit) {
    return limit ? std::optional(kLitresPerMinute * limit->leak_flow_m3_per_s) : std::nullopt;
  };
  StoredSmallestLeak told;
  told.signal = signal.signal;
  told.repeats_averaged = signal.repeats;
  told.averaged = flow(signal.smallest_leak);
  told.single = flow(signal.smallest_single_leak);
  if (const auto& limit = signal.smallest_leak)
    told.averaged_share_percent = kInPercent * limit->share;
  told.repeat_sd_m = signal.errors.repeat_m;
  told.healthy_leak_m = signal.errors.healthy_m;
  told.reason = unless_empty(signal.reason);
  if (signal.of_another_day) {
    told.of_another_day = true;
    if (const auto limit = flow(signal.smallest_leak_same_day)) told.averaged_same_day = *limit;
    if (const auto limit = flow(signal.smallest_single_leak_same_day))
      told.single_same_day = *limit;
  }
  return told;
}

StoredBetweenDays stored(const diagnosis::BetweenDays& between,
                         const std::vector<std::string>& other_days) {
  constexpr std::array kSources{"usual", "stated", "estimated"};
  StoredBetweenDays told;
  told.other_days = other_days;
  told.source = kSources.at(static_cast<std::size_t>(between.source));
  told.factor = std::sqrt(between.variance);
  if (between.source == diagnosis::DaySource::estimated) told.freedom = between.freedom;
  told.healthy_dates = between.dates;
  for (const calib::DayQuantity& each : between.quantities)
    told.quantities.push_back(
        {each.key, each.meaning, each.unit, told.factor * each.sd, each.sd_from});
  told.sentence = unless_empty(diagnosis::in_words(between, other_days));
  return told;
}

StoredDiagnosisSettings stored(const datasets::DiagnosisSettings& settings) {
  StoredDiagnosisSettings told{
      {}, settings.least_probability, settings.false_alarms, settings.detection, {}};
  if (settings.leak_law != datasets::LeakLaw::orifice) told.leak_law = settings.leak_law;
  for (std::size_t i = 0; i < settings.limits.size(); ++i) {
    told.limits_percent.emplace_back(to_string(datasets::kLeakClasses[i]),
                                     kInPercent * settings.limits[i]);
  }
  return told;
}

}  // namespace

StoredDiagnosis stored(const DiagnosisResult& result) {
  const diagnosis::Diagnosis& found = result.diagnosis;
  const datasets::Campaign& campaign = result.campaign;
  StoredDiagnosis file;
  file.status = status_of(result);
  file.reasons = result.reasons;
  file.campaign = campaign.name;
  file.synthetic = campaign.synthetic;
  file.report = identity_json(campaign);
  file.settings = stored(campaign.diagnosis);
  for (const calib::LeakEntry& limit : result.class_limits) {
    file.class_limits.push_back({drive_of(campaign, limit.drive), limit.target_percent,
                                 class_ending_at(campaign.diagnosis, limit.target_percent),
                                 limit.coefficients, limit.coefficients_ci95});
  }
  for (const auto& state : found.states) file.states.push_back(stored(state));
  file.trends = found.trends;
  for (diagnosis::LeakTrend& trend : file.trends) trend.sentence = trend_sentence(trend);
  for (const auto& record : found.records) file.records.push_back(stored(record));
  file.methods = found.methods;
  const diagnosis::Accuracy& single = found.methods.fitted_leak_single;
  file.confusion = single.confusion;
  file.accuracy = single.accuracy;
  file.accuracy_ci95 = single.accuracy_ci95;
  for (const auto& signal : found.signals) file.smallest_leak_l_per_min.push_back(stored(signal));
  if (found.usable()) file.between_days = stored(found.between_days, found.other_days);
  file.warnings = found.warnings;
  file.provenance = stored(result.provenance);
  return file;
}

}  // namespace rigcal::report
