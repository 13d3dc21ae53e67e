#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/prepare/single_repeats.hpp"
#include "diagnosis/machine/between_days.hpp"
#include "diagnosis/record/leak_fit.hpp"
#include "metrics/residual_features.hpp"

namespace rigcal::diagnosis {

struct ParityOptions {
  double false_alarm = 0.01;  ///< probability that a healthy record raises an alarm
  int threads = 1;            ///< the results are bitwise identical for any number
  const std::atomic<bool>* cancel = nullptr;
  /// Called from any thread with the number of conditions done and the total number.
  std::function<void(int, int)> progress;
};

/// Thresholds for the features in the source paper (Table 4), from healthy records.
using FeatureThresholds = metrics::ByFeature<std::optional<double>>;

/// Parity residual of one record: position minus that of the healthy model under the same reference
/// (eq. 14). The mean of this residual over healthy records of the signal, which shows what the
/// model lacks, is then subtracted. A healthy record is compared with the other healthy records.
struct ParityRecord {
  std::string condition;
  std::optional<int> repeat;  ///< counted from 1; absent for a file that is already averaged
  std::string signal;
  std::optional<std::string> leak_level;
  bool healthy = false;
  /// True if the threshold is based on this healthy record, which is then not judged.
  bool sets_threshold = false;
  int reference_records = 0;           ///< number of healthy records whose mean was subtracted
  std::optional<std::string> failure;  ///< why there is no residual
  std::optional<double> peak_m;        ///< largest moving RMS
  std::optional<bool> alarm;  ///< true if peak_m exceeds the threshold; absent if not judged
  std::optional<double>
      time_to_alarm_s;  ///< from the first sample to the first above the threshold
  metrics::ByFeature<std::optional<double>> features;
  metrics::ByFeature<std::optional<bool>> exceeds;  ///< absent without a threshold
  Omittable<double> threshold_m;                    ///< for peak_m on the day of the record
  RIGCAL_DESCRIBE(condition, repeat, signal, leak_level, healthy, sets_threshold, reference_records,
                  failure, peak_m, alarm, time_to_alarm_s, features, exceeds, threshold_m)
};

/// The record with its series, shape (samples).
struct ParityResidual : ParityRecord {
  std::vector<double> parity_m;      ///< before a reference is subtracted
  std::vector<double> residual_m;    ///< minus the reference; NaN for samples that do not count
  std::vector<double> moving_rms_m;  ///< over the window of the signal
  DayWeights days;                   ///< day of the record relative to the days of its reference
};

/// Records of one condition on a common time base.
struct ParityCondition {
  std::string condition;
  std::vector<double> time_s;
  std::vector<double> model_m;  ///< position of the healthy model; empty if the simulation failed
  /// Change in that position with each quantity that differs between days, per standard deviation.
  /// Shape (samples, quantities).
  Eigen::MatrixXd day_changes_m;
  std::vector<ParityResidual> records;
};

/// Thresholds from the healthy records of one signal.
struct ParitySignal {
  std::string signal;
  double window_s = 0.0;    ///< window of the moving RMS: a period, or a tenth of the record
  int healthy_records = 0;  ///< number of records on which the thresholds are based
  std::optional<double> threshold_m;  ///< threshold for peak_m of a record from the same day
  /// Threshold for peak_m of a record from a day on which no healthy record was made.
  Omittable<double> threshold_of_another_day_m;
  FeatureThresholds feature_thresholds;
  std::optional<std::string> reason;   ///< why there is no threshold, in words
  Omittable<int> common_causes = {0};  ///< number of causes that make healthy records differ
  RIGCAL_DESCRIBE(signal, window_s, healthy_records, threshold_m, feature_thresholds, reason,
                  threshold_of_another_day_m, common_causes)
};

/// Comparison of the alarms raised by healthy records that set no threshold with the stated rate.
struct FalseAlarmCheck {
  int records = 0;
  int alarms = 0;
  double expected = 0.0;  ///< expected number of alarms at the stated rate
  /// Probability of at least this many alarms at the stated rate (binomial); absent without
  /// records.
  std::optional<double> p_value;
  RIGCAL_DESCRIBE(records, alarms, expected, p_value)
};

struct Parity {
  std::vector<ParityCondition> conditions;  ///< in campaign order
  std::vector<ParitySignal> signals;        ///< in order of first appearance
  FalseAlarmCheck check;
  BetweenDays between_days;
  std::vector<std::string> warnings;
  bool usable() const;  ///< true if there is at least one residual
};

/// Computes the parity residual of every record, and thresholds for each signal. If a signal has
/// enough healthy records with use `fit`, the thresholds are based on those, so that the other
/// healthy records, which come from other days, can be used to check them. Otherwise the thresholds
/// are based on all healthy records.
///
/// @param records  records of the conditions that can be diagnosed (diagnosable())
/// @throws InputError  if the records or the campaign are wrong, or if a healthy level is not a
///                     level of the campaign
Parity parity(const datasets::Campaign& campaign,
              const std::vector<datasets::RepeatRecords>& records, const RigFit& rig,
              const ParityOptions& options);

}  // namespace rigcal::diagnosis
