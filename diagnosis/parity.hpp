#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/prepare/single_repeats.hpp"
#include "diagnosis/between_days.hpp"
#include "diagnosis/leak/leak_fit.hpp"
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
  std::string condition, signal;
  std::optional<int> repeat;  ///< counted from 1; absent for a file that is already averaged
  bool is_healthy = false;
  /// True if the threshold is based on this healthy record, which then raises no alarm.
  bool sets_threshold = false;
  int reference_records = 0;     ///< number of healthy records whose mean was subtracted
  std::string failure;           ///< why there is no residual; empty if there is one
  std::vector<double> parity_m;  ///< shape (samples), before a reference is subtracted
  /// Parity_m minus the reference; NaN for samples that do not count.
  std::vector<double> residual_m;
  std::vector<double> moving_rms_m;    ///< moving RMS over the window of the signal
  metrics::ResidualFeatures features;  ///< computed from residual_m
  double peak_m = 0.0;                 ///< largest moving_rms_m
  DayWeights days;                     ///< day of the record relative to the days of its reference
  /// Thresholds for peak_m and the features on the day of the record.
  std::optional<double> threshold_m;
  FeatureThresholds feature_thresholds;
  bool alarm = false;         ///< true if peak_m exceeds the threshold
  double alarm_time_s = 0.0;  ///< time from the first sample to the first one above the threshold
};

/// Records of one condition on a common time base.
struct ParityCondition {
  std::string condition;
  std::vector<double> time_s;
  std::vector<double> model_m;  ///< position of the healthy model; empty if the simulation failed
  /// Change in that position with each quantity that differs between days, per standard deviation.
  /// Shape (samples, quantities).
  Eigen::MatrixXd day_changes_m;
  std::vector<ParityRecord> records;
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
  /// Days of records that are not from the day of their reference.
  std::vector<std::string> other_days;
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
