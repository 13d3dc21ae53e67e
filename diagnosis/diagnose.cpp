#include "diagnosis/diagnose.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "common/parallel.hpp"
#include "common/quantity.hpp"
#include "datasets/prepare/single_repeats.hpp"
#include "diagnosis/feature_clusters.hpp"
#include "diagnosis/machine/machine_states.hpp"
#include "diagnosis/record/healthy_reference.hpp"
#include "diagnosis/record/leak_budget.hpp"
#include "diagnosis/record/obstacles.hpp"
#include "diagnosis/record/prepared.hpp"
#include "diagnosis/record/record_diagnosis.hpp"
#include "diagnosis/record/residual_rms.hpp"
#include "diagnosis/record/signal_name.hpp"

namespace rigcal::diagnosis {
namespace {

using datasets::Campaign;
using datasets::Condition;

Prepared prepare(const LeakProblem& problem, const RigFit& rig,
                 const datasets::RepeatRecords& records, const DiagnosisOptions& options,
                 HealthyEffects& healthy) {
  Prepared result;
  result.condition = problem.campaign.find(records.average.condition);
  if (result.condition == nullptr)
    throw std::invalid_argument("diagnose: no condition " + records.average.condition);
  result.records = &records;
  try {
    result.scan = leak_scan_of(problem, *result.condition, records.average);
    result.leaks = result.memo(rig.indices);
    result.effects =
        leak_effects_of(problem, rig, *result.condition, records.average, result.scan, healthy);
    std::vector<const datasets::Record*> all{&records.average};
    for (const datasets::Record& single : records.singles) all.push_back(&single);
    result.residuals = healthy_residuals(problem, *result.condition, records.average, all);
    if (options.truth)
      result.true_share = share_at(problem.campaign, *result.condition, records.average,
                                   *options.truth, options.cancel);
  } catch (const NoResultError& error) {
    result.failure = error.what();
  }
  return result;
}

/// A fit to be made: one record of a condition.
struct Task {
  const Prepared* prepared = nullptr;
  int single = -1;  ///< index of the repeat, or -1 for the average
};

/// A repeat of a healthy condition, or its average if it has no repeats.
struct Reference {
  const Prepared* prepared = nullptr;
  std::size_t index = 0;  ///< index in the residuals
};

std::vector<Reference> references_of(const Campaign& campaign, const std::vector<Prepared>& all,
                                     const std::string& signal) {
  std::vector<Reference> references;
  for (const Prepared& each : all) {
    if (each.residuals.empty() || each.condition->waveform == datasets::Waveform::recorded ||
        !each.is_healthy || signal_name(campaign, *each.condition) != signal)
      continue;
    if (each.residuals.size() == 1) references.push_back({&each, 0});
    for (std::size_t i = 1; i < each.residuals.size(); ++i) references.push_back({&each, i});
  }
  return references;
}

RecordDiagnosis diagnose_record(const LeakProblem& problem, const RigFit& rig, const Task& task,
                                const std::vector<Prepared>& all, const BetweenDays& between,
                                const DiagnosisOptions& options, std::optional<LeakRuns>& runs) {
  const Prepared& prepared = *task.prepared;
  const datasets::RepeatRecords& records = *prepared.records;
  RecordDiagnosis result;
  result.condition = prepared.condition->id;
  result.signal = signal_name(problem.campaign, *prepared.condition);
  result.days = day_weights(between, problem.campaign, *prepared.condition, {});
  if (!prepared.failure.empty()) {
    result.fit.failure = prepared.failure;
    return result;
  }
  const bool is_single = task.single >= 0;
  const auto index = static_cast<std::size_t>(task.single + 1);
  datasets::Record record = is_single ? records.singles[index - 1] : records.average;
  std::optional<datasets::TimeWindow> covered;
  if (is_single) {
    covered = records.covered[index - 1];
    result.repeat = static_cast<int>(index);
  } else {
    result.repeats_averaged = records.average.repeats;
  }
  const auto& residual = prepared.residuals[index].at(datasets::Channel::position);
  const metrics::ResidualFeatures features = features_within(residual, record.time_s, covered);
  result.features = {features.mean, features.rms, features.std};

  std::vector<Reference> references = references_of(problem.campaign, all, result.signal);
  if (is_single || references.size() > prepared.residuals.size() - 1) {
    const auto own = std::erase_if(references, [&](const Reference& each) {
      return each.prepared == &prepared && (!is_single || each.index == index);
    });
    result.corrects_others = is_single && own > 0;
  } else {
    result.is_reference =
        std::any_of(references.begin(), references.end(),
                    [&](const Reference& each) { return each.prepared == &prepared; });
  }
  if (!references.empty()) {
    std::vector<TimedResidual> residuals;
    std::vector<const Condition*> conditions;
    for (const Reference& each : references) {
      residuals.push_back({&each.prepared->residuals[each.index], &each.prepared->time_s()});
      conditions.push_back(each.prepared->condition);
    }
    take_off(residuals, record);
    result.days = day_weights(between, problem.campaign, *prepared.condition, conditions);
  }
  result.reference_repeats = static_cast<int>(references.size());

  const LeakProblem bounded = problem.up_to(2.0 * prepared.scan.largest_coefficient)
                                  .corrected_by(result.reference_repeats, record.repeats);
  result.fit =
      fit_leak(bounded, rig, *prepared.condition, record, covered, result.reference_repeats,
               &prepared.scan, options.cancel, prepared.effects.get(), &runs);
  return result;
}

struct SignalRecords {
  /// Single repeats of each condition.
  std::map<std::string, std::vector<RecordDiagnosis*>> singles;
  std::vector<RecordDiagnosis*> healthy;  ///< averages and single repeats of healthy conditions
  std::vector<const LeakFit*> averages;   ///< except those that are their own reference
};

std::map<std::string, SignalRecords> by_signal(const Campaign& campaign,
                                               std::vector<RecordDiagnosis>& records) {
  std::map<std::string, SignalRecords> signals;
  for (RecordDiagnosis& record : records) {
    if (!record.fit.ok()) continue;
    SignalRecords& own = signals[record.signal];
    if (record.repeat) own.singles[record.condition].push_back(&record);
    if (!record.repeat && !record.is_reference) own.averages.push_back(&record.fit);
    if (is_healthy(campaign, *campaign.find(record.condition))) own.healthy.push_back(&record);
  }
  return signals;
}

SignalErrors errors_of(const SignalRecords& records) {
  std::vector<std::vector<SingleFit>> singles;
  for (const auto& [condition, members] : records.singles) {
    auto& own = singles.emplace_back();
    for (const RecordDiagnosis* each : members)
      own.push_back({&each->fit, each->corrects_others ? each->reference_repeats : 0});
  }
  std::vector<const LeakFit*> healthy;
  for (const RecordDiagnosis* each : records.healthy) {
    if (!each->repeat) healthy.push_back(&each->fit);
  }
  return signal_errors(singles, healthy, records.averages);
}

/// Returns the largest structured parity residual that the healthy model leaves in a signal's
/// healthy records [m].
double healthy_misfit(const SignalRecords& records) {
  double largest = 0.0;
  for (const RecordDiagnosis* each : records.healthy)
    largest = std::max(largest, structured_rms(each->fit.parity_rms_m, each->fit.noise_rms_m));
  return largest;
}

/// Sets the known share and class of a record, if there are any.
void set_truth(const Campaign& campaign, const std::optional<double>& true_share,
               RecordDiagnosis& record) {
  const Condition& condition = *campaign.find(record.condition);
  const auto& known = campaign.diagnosis.level_class;
  if (condition.leak_level) {
    const auto level = known.find(*condition.leak_level);
    if (level != known.end()) record.true_class = level->second;
  }
  if (!true_share) return;
  record.true_share_percent = kInPercent * *true_share;
  record.true_class = class_of(campaign.diagnosis, *true_share);
}

void classify_by_features(std::vector<RecordDiagnosis>& records) {
  const auto features_of = [](const RecordDiagnosis& record) {
    const auto& [mean_m, rms_m, std_m] = record.features;
    return metrics::ResidualFeatures{mean_m.value(), rms_m.value(), std_m.value()};
  };
  std::vector<LabelledFeatures> labelled;
  for (const RecordDiagnosis& record : records) {
    if (record.fit.ok() && record.true_class && record.repeat)
      labelled.push_back({record.signal, *record.repeat, *record.true_class, features_of(record)});
  }
  for (RecordDiagnosis& record : records) {
    if (!record.fit.ok()) continue;
    const LabelledFeatures own{record.signal, record.repeat.value_or(0), LeakClass::normal,
                               features_of(record)};
    record.class_by_features = class_without_repeat(labelled, own);
    record.class_by_features_of_other_signals = class_without_signal(labelled, own);
  }
}

enum class Method { fitted_leak, features };

/// Skips records that could not be classified by features because there was nothing to learn from.
/// A fitted leak counts even if its class is undecided.
template <typename Found>
Accuracy accuracy(const std::vector<RecordDiagnosis>& records, Method method, bool single,
                  Found found) {
  std::vector<Judged> judged;
  for (const RecordDiagnosis& record : records) {
    if (method == Method::features && !found(record)) continue;
    if (record.true_class && record.repeat.has_value() == single && !record.is_reference)
      judged.push_back({record.condition, *record.true_class, found(record)});
  }
  return accuracy_of(judged);
}

/// Estimates the share of a record and, if the record is healthy, the smallest detectable leak. If
/// the share cannot be simulated, the record counts as not diagnosed.
void estimate(const LeakProblem& problem, const RigFit& rig, const Prepared& prepared,
              const SignalErrors& errors, const BetweenDays& between, RecordDiagnosis& record) {
  const CoefficientError of_its_day =
      coefficient_error(record.fit, errors, record.repeats_averaged, record.reference_repeats);
  const double distance = record.days.norm();
  const CoefficientError error = with_days(
      of_its_day, between.error(distance, record.fit.day_effects), between.degrees_of_freedom());
  const datasets::Record& average = prepared.records->average;
  const double least = prepared.least_reach();
  try {
    const LeakCurve curve =
        leak_curve_of(problem, *prepared.condition, average, record.fit.coefficient,
                      std::max(error.half_width(), least), *prepared.leaks);
    const double share_slope = curve.share_slope(record.fit.coefficient);
    const Eigen::VectorXd share_moves =
        share_rig_moves(problem, rig, *prepared.condition, average, record.fit, share_slope,
                        *prepared.leaks, prepared.negligible(), prepared.effects.get());
    const double share_days_se =
        distance > 0.0
            ? between.error(distance, share_day_effects(problem, *prepared.condition, average,
                                                        record.fit, share_slope,
                                                        *prepared.day_leaks, prepared.negligible()))
            : 0.0;
    record.estimate = estimate_leak(record.fit.coefficient, error, curve,
                                    std::hypot(rig.error(share_moves), share_days_se),
                                    problem.campaign.diagnosis);
    record.estimate.budget = coefficient_budget(error, rig.contributions(record.fit.rig_moves));
    record.estimate.share_budget =
        share_budget(error, share_slope, rig.contributions(share_moves), share_days_se);
    if (!prepared.is_healthy) return;
    // A record that is its own reference has no error relative to it, so the error of an average is
    // used.
    const auto of_healthy = record.is_reference
                                ? error_of_averages(record.fit, errors, record.repeats_averaged,
                                                    record.reference_repeats)
                                : std::optional(of_its_day);
    if (!of_healthy || !(of_healthy->total() > 0.0)) return;
    const auto limit_of = [&](const CoefficientError& each) -> std::optional<DetectionLimit> {
      const double limit = detection_limit(each, problem.campaign.diagnosis);
      const LeakPoint smallest = leak_point_of(problem, *prepared.condition, average, limit,
                                               std::max(limit, least), *prepared.leaks);
      if (smallest.share > 1.0) return std::nullopt;
      return DetectionLimit{limit, std::max(0.0, smallest.leak_flow_m3_per_s),
                            std::max(0.0, smallest.share)};
    };
    record.smallest_leak = limit_of(*of_healthy);
    const double another = record.days.norm_of_another_day();
    record.smallest_leak_of_another_day = limit_of(with_days(
        *of_healthy, between.error(another, record.fit.day_effects), between.degrees_of_freedom()));
  } catch (const NoResultError& failure) {
    record.fit.failure = failure.what();
  }
}

/// Returns the largest limit of the healthy averages of a signal, or of its healthy repeats.
std::optional<DetectionLimit> largest_limit(const SignalRecords& records, bool of_averages,
                                            std::optional<DetectionLimit> RecordDiagnosis::*limit) {
  std::optional<DetectionLimit> largest;
  for (const RecordDiagnosis* each : records.healthy) {
    if (each->fit.ok() && each->*limit && each->is_average() == of_averages)
      keep_larger(*(each->*limit), largest);
  }
  return largest;
}

std::optional<double> flow_l_per_min(const std::optional<DetectionLimit>& limit) {
  return limit ? std::optional(kLitresPerMinute * limit->leak_flow_m3_per_s) : std::nullopt;
}

SmallestLeak smallest_leak_of(const SignalRecords& records, const SignalErrors& errors,
                              const std::string& signal, bool of_another_day) {
  SmallestLeak result;
  result.signal = signal;
  for (const RecordDiagnosis* each : records.healthy) {
    if (each->is_average() && each->smallest_leak) result.repeats_averaged = each->repeats_averaged;
  }
  const auto limit = of_another_day ? &RecordDiagnosis::smallest_leak_of_another_day
                                    : &RecordDiagnosis::smallest_leak;
  const auto averaged = largest_limit(records, true, limit);
  result.averaged = flow_l_per_min(averaged);
  result.single = flow_l_per_min(largest_limit(records, false, limit));
  if (averaged) result.averaged_share_percent = kInPercent * averaged->share;
  result.repeat_sd_m = errors.repeat_m;
  result.healthy_leak_m = errors.healthy_m;
  if (of_another_day) {
    const auto same_day = &RecordDiagnosis::smallest_leak;
    result.of_another_day = true;
    result.averaged_same_day = flow_l_per_min(largest_limit(records, true, same_day));
    result.single_same_day = flow_l_per_min(largest_limit(records, false, same_day));
  }
  if (records.healthy.empty()) {
    result.reason = "no healthy record of this signal";
  } else if (!averaged) {
    result.reason = "without repeats the variation of healthy records of this signal is unknown";
  }
  return result;
}

/// Returns the days of those records that are not from the day of their reference, in order of
/// first appearance.
std::vector<std::string> days_off_reference(const Campaign& campaign,
                                            const std::vector<RecordDiagnosis>& records) {
  std::vector<std::string> days;
  for (const RecordDiagnosis& record : records) {
    if (!(record.days.norm() > 0.0)) continue;
    const std::string day = day_label(*campaign.find(record.condition));
    if (std::find(days.begin(), days.end(), day) == days.end()) days.push_back(day);
  }
  return days;
}

/// Collects the dated healthy averages from which the variation between days is estimated.
std::vector<HealthyDay> healthy_days(const Campaign& campaign,
                                     const std::vector<RecordDiagnosis>& records,
                                     const std::map<std::string, SignalErrors>& errors) {
  std::vector<HealthyDay> days;
  for (const RecordDiagnosis& record : records) {
    const Condition& condition = *campaign.find(record.condition);
    if (!record.fit.ok() || record.repeat || record.is_reference || !condition.date ||
        !is_healthy(campaign, condition))
      continue;
    const double own = coefficient_error(record.fit, errors.at(record.signal),
                                         record.repeats_averaged, record.reference_repeats)
                           .total();
    const double by_days = record.days.norm() * record.fit.day_effects.norm();
    days.push_back({record.fit.coefficient, own * own, by_days * by_days});
  }
  return days;
}

/// Sets what results state of a record, whether or not it was judged.
void complete(RecordDiagnosis& record) {
  const LeakFit& fit = record.fit;
  record.undecided = !record.leak.class_ && !record.is_reference && !record.estimate.incompatible;
  if (!fit.ok()) {
    record.failure = fit.failure;
    record.features = {};
    return;
  }
  record.parity_rms_m = fit.parity_rms_m;
  record.misfit_rms_m = fit.misfit_rms_m;
  record.noise_rms_m = fit.noise_rms_m;
}

}  // namespace

bool Diagnosis::usable() const {
  return std::any_of(records.begin(), records.end(),
                     [](const RecordDiagnosis& record) { return !record.failure; });
}

Diagnosable diagnosable(const Campaign& campaign) {
  Diagnosable result;
  for (const Condition* condition : diagnosed_conditions(campaign)) {
    const auto lacks = lacks_for_diagnosis(campaign, *condition);
    if (lacks.empty()) {
      result.conditions.push_back(condition);
    } else {
      result.left_out.push_back(
          fmt::format("condition \"{}\" is left out: {}", condition->id, fmt::join(lacks, "; ")));
    }
  }
  return result;
}

Diagnosis diagnose(const Campaign& campaign, const std::vector<datasets::RepeatRecords>& records,
                   const RigFit& rig, const DiagnosisOptions& options) {
  Diagnosis result;
  result.settings = stated(campaign.diagnosis);
  LeakProblem problem(campaign, rig);
  problem.cancel = options.cancel;
  std::vector<Prepared> prepared(records.size());
  HealthyEffects healthy;
  parallel_for(prepared.size(), options.threads, [&](std::size_t i) {
    prepared[i] = prepare(problem, rig, records[i], options, healthy);
  });
  // The campaign in `problem` no longer contains the known leaks.
  for (Prepared& each : prepared)
    each.is_healthy = is_healthy(campaign, *campaign.find(each.condition->id));
  BetweenDays between;
  if (!campaign.conditions.empty())
    between = between_days_of(campaign, rig_values(problem), shortest_interval(records));
  problem.day_quantities = between.quantities;
  for (Prepared& each : prepared)
    each.day_leaks = each.memo(calib::further_rows(problem.day_quantities, {}));
  std::vector<Task> tasks;
  std::vector<std::size_t> begin;  // index of the first task of each condition
  for (const Prepared& each : prepared) {
    begin.push_back(tasks.size());
    for (int single = -1; single < static_cast<int>(each.records->singles.size()); ++single)
      tasks.push_back({&each, single});
  }
  result.records.resize(tasks.size());
  // A record is done after two passes: its leak is fitted in the first and judged in the second.
  std::atomic<int> halves{0};
  const auto half_done = [&] {
    const int done = ++halves / 2;
    if (options.progress) options.progress(done, static_cast<int>(tasks.size()));
  };
  begin.push_back(tasks.size());
  // The average of a condition comes first, because the repeats reuse its simulation without a
  // leak.
  parallel_for(prepared.size(), options.threads, [&](std::size_t condition) {
    std::optional<LeakRuns> runs;
    for (std::size_t i = begin[condition]; i < begin[condition + 1]; ++i) {
      result.records[i] = diagnose_record(problem, rig, tasks[i], prepared, between, options, runs);
      half_done();
    }
  });

  const auto signals = by_signal(campaign, result.records);
  std::map<std::string, SignalErrors> errors;
  std::vector<SignalErrors*> all_errors;
  for (const auto& [signal, members] : signals)
    all_errors.push_back(&(errors[signal] = errors_of(members)));
  separate_noise(all_errors);
  between.other_days = days_off_reference(campaign, result.records);
  estimate_days(healthy_days(campaign, result.records, errors), between);
  parallel_for(tasks.size(), options.threads, [&](std::size_t i) {
    RecordDiagnosis& record = result.records[i];
    if (record.fit.ok())
      estimate(problem, rig, *tasks[i].prepared, errors.at(record.signal), between, record);
    half_done();
  });
  for (const auto& [signal, members] : signals) {
    const double healthy_m = healthy_misfit(members);
    for (RecordDiagnosis& record : result.records) {
      if (!record.fit.ok() || record.signal != signal) continue;
      // A difference that may be due to day-to-day differences does not indicate another fault.
      const double of_days_m = record.days.norm() * between.factor * record.fit.day_rms_m;
      judge(record, errors.at(signal), std::hypot(healthy_m, of_days_m), campaign.diagnosis);
    }
    result.smallest_leak_l_per_min.push_back(
        smallest_leak_of(members, errors.at(signal), signal, !between.other_days.empty()));
  }
  const DayVariance variance{between.variance, between.degrees_of_freedom()};
  result.states = machine_states(problem, rig, prepared, result.records, errors, variance);
  result.trends = leak_trends(result.states, rig.covariance, campaign.diagnosis, variance);
  for (std::size_t i = 0; i < tasks.size(); ++i)
    set_truth(campaign, tasks[i].prepared->true_share, result.records[i]);
  classify_by_features(result.records);
  for (RecordDiagnosis& record : result.records) complete(record);
  const auto by_leak = [](const RecordDiagnosis& record) { return record.leak.class_; };
  result.methods = {
      accuracy(result.records, Method::fitted_leak, true, by_leak),
      accuracy(result.records, Method::fitted_leak, false, by_leak),
      accuracy(result.records, Method::features, true,
               [](const RecordDiagnosis& record) { return record.class_by_features; }),
      accuracy(result.records, Method::features, true, [](const RecordDiagnosis& record) {
        return record.class_by_features_of_other_signals;
      })};
  const Accuracy& single = result.methods.fitted_leak_single;
  result.confusion = single.confusion;
  result.accuracy = single.accuracy;
  result.accuracy_ci95 = single.accuracy_ci95;
  for (const std::string& each : confounded(campaign)) result.warnings.push_back(each);
  between.sentence = in_words(between);
  if (between.sentence) result.warnings.push_back(*between.sentence);
  if (result.usable()) result.between_days = between;
  for (const std::string& each : too_few_dates(result.states)) result.warnings.push_back(each);
  return result;
}

}  // namespace rigcal::diagnosis
