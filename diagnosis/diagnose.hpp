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
  int threads = 1;  ///< results are the same bits for any number
  const std::atomic<bool>* cancel = nullptr;
  /// True values by which a synthetic campaign was made; the diagnosis is judged by them.
  std::optional<std::vector<datasets::FittedValue>> truth;
  /// Called after every finished record: number done, total number. From any thread.
  std::function<void(int, int)> progress;
};

/// Diagnosis of one record.
struct RecordDiagnosis {
  std::string condition;
  std::string signal;         ///< "sine 0.1 Hz, 50.8 mm"
  std::optional<int> repeat;  ///< from 1; empty: the average
  int repeats = 1;            ///< number of repeats in the record's mean
  /// Healthy repeats of the same signal whose parity residual was subtracted from the record; 0:
  /// none.
  int reference_repeats = 0;
  /// A repeat of a healthy condition that was corrected by the other healthy repeats.
  bool corrects_others = false;
  /// It is itself that reference, so that its leak is zero by construction.
  bool is_reference = false;
  DayWeights days;                     ///< its day against those of its reference
  LeakFit fit;                         ///< gives the reason if nothing was found
  metrics::ResidualFeatures features;  ///< for the parity residual, eq. 14, uncorrected [m]
  LeakEstimate estimate;               ///< valid only if fit.ok()
  /// For a healthy record whose errors are known: of a record of the reference's day, and of one of
  /// another day.
  std::optional<DetectionLimit> smallest_leak, smallest_leak_of_another_day;
  /// The leak leaves more than a third of the difference from the healthy model unexplained: there
  /// is another fault.
  bool unexplained = false;
  std::optional<LeakClass> leak_class;  ///< empty: undecided
  /// By the paper's features, with clusters learned without this repeat, and without this signal;
  /// empty without a labelled record to learn from.
  std::optional<LeakClass> by_features;
  std::optional<LeakClass> by_features_of_other_signals;
  std::optional<double> true_share;
  std::optional<LeakClass> truth;
  std::vector<std::string> warnings;
};

/// Joint result of the records of one signal.
struct SignalDiagnosis {
  std::string signal;
  SignalErrors errors;
  std::optional<DetectionLimit> smallest_leak;         ///< in an average
  std::optional<DetectionLimit> smallest_single_leak;  ///< in a single repeat
  /// The two above are those of a record of another day than its reference, since there are such.
  bool of_another_day = false;
  /// On the day of the reference.
  std::optional<DetectionLimit> smallest_leak_same_day, smallest_single_leak_same_day;
  int repeats = 1;     ///< repeats in that average
  std::string reason;  ///< why there is no limit, in words
};

struct Diagnosis {
  std::vector<RecordDiagnosis> records;  ///< campaign order; the average, then its repeats
  std::vector<SignalDiagnosis> signals;  ///< in order of their first appearance
  std::vector<MachineState> states;      ///< in order of their first appearance
  BetweenDays between_days;              ///< what was taken of it
  std::vector<std::string> other_days;   ///< days of records that are not of their reference's
  std::vector<LeakTrend> trends;         ///< trends over states that differ only in their date
  Accuracy single;                       ///< fitted leak, single repeats
  Accuracy averaged;                     ///< fitted leak, averages
  Accuracy features;                     ///< paper's features, without the repeat in question
  Accuracy features_of_other_signals;
  std::vector<std::string> warnings;
  /// True if at least one record was diagnosed.
  bool usable() const;
};

/// Conditions that can be diagnosed, and why others cannot, in words.
struct Diagnosable {
  std::vector<const datasets::Condition*> conditions;
  std::vector<std::string> left_out;
};
Diagnosable diagnosable(const datasets::Campaign& campaign);

/// Fits a leak to the average and to every single repeat of some conditions, and classifies them by
/// two methods.
///
/// Healthy records of a signal calibrate it. Their difference from the healthy model, such as
/// friction or a lag that it lacks, is subtracted from every record of the same generated signal
/// before a leak is fitted. A healthy repeat is corrected by the others; the average of healthy
/// repeats is the reference itself.
///
/// @param records  of diagnosable conditions, found by the name in their average
/// @throws InputError  records or campaign are wrong
Diagnosis diagnose(const datasets::Campaign& campaign,
                   const std::vector<datasets::RepeatRecords>& records, const RigFit& rig,
                   const DiagnosisOptions& options);

}  // namespace rigcal::diagnosis
