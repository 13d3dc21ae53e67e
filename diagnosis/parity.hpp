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
  int threads = 1;            ///< results are the same bits for any number
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(int, int)> progress;  ///< conditions done, of how many; from any thread
};

/// Thresholds for features of the source paper (Table 4), from healthy records.
using FeatureThresholds = metrics::ByFeature<std::optional<double>>;

/// The parity residual of one record: position minus that of the healthy model under the same
/// reference (eq. 14), minus the mean of that residual over healthy records of the signal, which is
/// the part that the model lacks. A healthy record is compared with the others.
struct ParityRecord {
  std::string condition, signal;
  std::optional<int> repeat;  ///< from 1; empty: a file that is averaged already
  bool is_healthy = false;
  /// One of the healthy records that the threshold rests on; it raises no alarm.
  bool sets_threshold = false;
  int reference_records = 0;           ///< healthy records whose mean was subtracted
  std::string failure;                 ///< why there is no residual; empty if there is one
  std::vector<double> parity_m;        ///< shape (samples), with nothing subtracted
  std::vector<double> residual_m;      ///< the same less the reference; NaN where it does not count
  std::vector<double> moving_rms_m;    ///< over the window of the signal
  metrics::ResidualFeatures features;  ///< features of residual_m
  double peak_m = 0.0;                 ///< largest moving_rms_m
  DayWeights days;                     ///< its day against those of its reference
  /// What peak_m and the features are compared with: of its day.
  std::optional<double> threshold_m;
  FeatureThresholds feature_thresholds;
  bool alarm = false;         ///< it exceeds the threshold of the signal
  double alarm_time_s = 0.0;  ///< from the first sample to the first that exceeds it
};

/// Records of one condition on one time base.
struct ParityCondition {
  std::string condition;
  std::vector<double> time_s;
  std::vector<double> model_m;  ///< position of the healthy model; empty where it failed
  /// Change of that position by each quantity that differs between days, per standard deviation,
  /// shape (samples, quantities).
  Eigen::MatrixXd day_changes_m;
  std::vector<ParityRecord> records;
};

/// Thresholds from the healthy records of one signal.
struct ParitySignal {
  std::string signal;
  double window_s = 0.0;    ///< moving root mean square: a period, else a tenth of the record
  int healthy_records = 0;  ///< number of records behind the thresholds
  std::optional<double> threshold_m;  ///< threshold for peak_m, of a record of the same day
  /// The same of a record of a day that the healthy records do not have.
  Omittable<double> threshold_of_another_day_m;
  FeatureThresholds feature_thresholds;
  std::optional<std::string> reason;   ///< why there is no threshold, in words
  Omittable<int> common_causes = {0};  ///< by which the healthy records differ beyond noise
  RIGCAL_DESCRIBE(signal, window_s, healthy_records, threshold_m, feature_thresholds, reason,
                  threshold_of_another_day_m, common_causes)
};

/// Healthy records on which no threshold rests: do they raise as many alarms as stated?
struct FalseAlarmCheck {
  int records = 0;
  int alarms = 0;
  double expected = 0.0;  ///< alarms at the stated rate
  /// Probability of so many alarms or more at that rate (binomial); absent without records.
  std::optional<double> p_value;
  RIGCAL_DESCRIBE(records, alarms, expected, p_value)
};

struct Parity {
  std::vector<ParityCondition> conditions;  ///< campaign order
  std::vector<ParitySignal> signals;        ///< in order of their first appearance
  FalseAlarmCheck check;
  BetweenDays between_days;
  std::vector<std::string> other_days;  ///< days of records that are not of their reference's
  std::vector<std::string> warnings;
  bool usable() const;  ///< there is a residual at least
};

/// Thresholds rest on the healthy records of use `fit` where there are enough of a signal, so that
/// the others, of other days, check them; else on all healthy ones.
///
/// @param records  of the campaign's conditions that can be diagnosed (diagnosable())
/// @throws InputError  records or campaign are wrong, a healthy level is not one of the campaign's
Parity parity(const datasets::Campaign& campaign,
              const std::vector<datasets::RepeatRecords>& records, const RigFit& rig,
              const ParityOptions& options);

}  // namespace rigcal::diagnosis
