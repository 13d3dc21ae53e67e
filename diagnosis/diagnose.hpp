#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "diagnosis/accuracy.hpp"
#include "diagnosis/between_days.hpp"
#include "diagnosis/leak/leak_estimate.hpp"
#include "diagnosis/leak/leak_fit.hpp"
#include "diagnosis/leak_trend.hpp"
#include "diagnosis/machine_state.hpp"
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

/// Diagnosis of one record.
struct RecordDiagnosis {
  std::string condition;
  std::string signal;         ///< such as "sine 0.1 Hz, 50.8 mm"
  std::optional<int> repeat;  ///< counted from 1; absent for the average
  int repeats = 1;            ///< number of repeats averaged in the record
  /// Number of healthy repeats of the same signal whose parity residual was subtracted from the
  /// record.
  int reference_repeats = 0;
  /// True for a repeat of a healthy condition, which is corrected by the other healthy repeats.
  bool corrects_others = false;
  /// True if the record is itself the healthy reference, so that its leak is zero by construction.
  bool is_reference = false;
  DayWeights days;                     ///< day of the record relative to the days of its reference
  LeakFit fit;                         ///< contains the reason if no leak could be fitted
  metrics::ResidualFeatures features;  ///< features of the uncorrected parity residual, eq. 14 [m]
  LeakEstimate estimate;               ///< valid only if fit.ok()
  /// For a healthy record whose errors are known, the smallest leak that could be detected in a
  /// record from the day of the reference, and in one from another day.
  std::optional<DetectionLimit> smallest_leak, smallest_leak_of_another_day;
  /// True if the leak leaves more than a third of the difference from the healthy model
  /// unexplained, which indicates another fault.
  bool unexplained = false;
  std::optional<LeakClass> leak_class;  ///< absent if undecided
  /// Class according to the paper's features, with clusters learned without this repeat, or without
  /// this signal. Absent if there is no labelled record to learn from.
  std::optional<LeakClass> by_features;
  std::optional<LeakClass> by_features_of_other_signals;
  std::optional<double> true_share;
  std::optional<LeakClass> truth;
  std::vector<std::string> warnings;
};

/// Joint result for the records of one signal.
struct SignalDiagnosis {
  std::string signal;
  SignalErrors errors;
  std::optional<DetectionLimit> smallest_leak;         ///< in an average of the signal
  std::optional<DetectionLimit> smallest_single_leak;  ///< in a single repeat
  /// True if the limits above are for a record from another day than its reference, because there
  /// are such records.
  bool of_another_day = false;
  /// Limits for a record from the day of the reference.
  std::optional<DetectionLimit> smallest_leak_same_day, smallest_single_leak_same_day;
  int repeats = 1;     ///< number of repeats in that average
  std::string reason;  ///< why there are no limits, in words
};

struct Diagnosis {
  /// In campaign order; each average comes before its repeats.
  std::vector<RecordDiagnosis> records;
  std::vector<SignalDiagnosis> signals;  ///< in order of first appearance
  std::vector<MachineState> states;      ///< in order of first appearance
  BetweenDays between_days;              ///< assumed variation between days
  /// Days of records that are not from the day of their reference.
  std::vector<std::string> other_days;
  std::vector<LeakTrend> trends;  ///< trends over states that differ only by date
  Methods methods;
  std::vector<std::string> warnings;
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
/// @throws InputError  if the records or the campaign are wrong
Diagnosis diagnose(const datasets::Campaign& campaign,
                   const std::vector<datasets::RepeatRecords>& records, const RigFit& rig,
                   const DiagnosisOptions& options);

}  // namespace rigcal::diagnosis
