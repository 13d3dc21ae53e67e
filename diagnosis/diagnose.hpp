#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/describe.hpp"
#include "datasets/campaign/campaign.hpp"
#include "diagnosis/accuracy.hpp"
#include "diagnosis/class_limits.hpp"
#include "diagnosis/machine/between_days.hpp"
#include "diagnosis/machine/leak_trend.hpp"
#include "diagnosis/machine/machine_state.hpp"
#include "diagnosis/record/leak_estimate.hpp"
#include "diagnosis/record/leak_fit.hpp"
#include "diagnosis/record/record_diagnosis.hpp"
#include "diagnosis/record/stated_leak.hpp"
#include "metrics/residual_features.hpp"

namespace rigcal::diagnosis {

struct DiagnosisOptions {
  int threads = 1;  ///< the results are bitwise identical for any number
  const std::atomic<bool>* cancel = nullptr;
  /// True values of a synthetic campaign, with which the diagnosis is judged.
  std::optional<std::vector<datasets::FittedValue>> truth;
  /// Called after every finished record with the number done and the total number. May be called
  /// from any thread.
  std::function<void(int, int)> progress;
};

/// The smallest leak that is detected in records of one signal [L/min].
struct SmallestLeak {
  std::string signal;
  int repeats_averaged = 1;                           ///< number of repeats in an average
  std::optional<double> averaged, single;             ///< in an average, in a single repeat
  std::optional<double> averaged_share_percent;       ///< share of `averaged`
  std::optional<double> repeat_sd_m, healthy_leak_m;  ///< see SignalErrors
  std::optional<std::string> reason;                  ///< why there is no such leak
  /// Present if `averaged` and `single` are for a record from another day than its reference,
  /// because there are such records. The two below are then for a record from the same day.
  Omittable<bool> of_another_day;
  Omittable<double> averaged_same_day, single_same_day;
  RIGCAL_DESCRIBE(signal, repeats_averaged, averaged, single, averaged_share_percent, repeat_sd_m,
                  healthy_leak_m, reason, of_another_day, averaged_same_day, single_same_day)
};

/// Result of a diagnosis, as in diagnosis.json.
struct Diagnosis {
  StatedSettings settings;
  std::vector<ClassLimit> class_limits;  ///< if a leak table set the limits
  std::vector<MachineState> states;      ///< in order of first appearance
  std::vector<LeakTrend> trends;         ///< trends over states that differ only by date
  /// In campaign order; each average comes before its repeats.
  std::vector<RecordDiagnosis> records;
  Confusion confusion;  ///< this and the accuracy are those of fitted leaks in single repeats
  std::optional<double> accuracy;
  std::optional<Range> accuracy_ci95;
  Methods methods;
  std::vector<SmallestLeak> smallest_leak_l_per_min;  ///< by signal, in order of first appearance
  Omittable<BetweenDays> between_days;  ///< assumed variation between days; present if usable
  std::vector<std::string> warnings;
  RIGCAL_DESCRIBE(settings, class_limits, states, trends, records, confusion, accuracy,
                  accuracy_ci95, methods, smallest_leak_l_per_min, between_days, warnings)

  /// Returns true if at least one record was diagnosed.
  bool usable() const;
};

/// Conditions that can be diagnosed, and why the others cannot, in words.
struct Diagnosable {
  std::vector<const datasets::Condition*> conditions;
  std::vector<std::string> left_out;
};
Diagnosable diagnosable(const datasets::Campaign& campaign);

/// Fits a leak to the average and to every single repeat of each condition, and classifies each of
/// them by two methods.
///
/// The healthy records of a signal serve as a reference. Their difference from the healthy model,
/// caused for example by friction or a lag that the model lacks, is subtracted from every record of
/// the same generated signal before a leak is fitted. A healthy repeat is corrected by the other
/// healthy repeats. The average of the healthy repeats is the reference itself.
///
/// @param records  records of the diagnosable conditions, identified by the condition of their
///                 average
/// @return  without class limits, which come from a leak table
/// @throws InputError  if the records or the campaign are wrong
Diagnosis diagnose(const datasets::Campaign& campaign,
                   const std::vector<datasets::RepeatRecords>& records, const RigFit& rig,
                   const DiagnosisOptions& options);

}  // namespace rigcal::diagnosis
