#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/describe.hpp"
#include "datasets/campaign/campaign.hpp"
#include "diagnosis/record/leak_estimate.hpp"
#include "diagnosis/record/leak_fit.hpp"
#include "diagnosis/record/signal_errors.hpp"
#include "diagnosis/record/stated_leak.hpp"
#include "metrics/residual_features.hpp"

namespace rigcal::diagnosis {

/// Diagnosis of one record.
struct RecordDiagnosis {
  std::string condition;
  std::optional<int> repeat;  ///< counted from 1; absent for the average
  int repeats_averaged = 1;   ///< number of repeats averaged in the record
  std::string signal;         ///< such as "sine 0.1 Hz, 50.8 mm"
  /// Number of healthy repeats of the same signal whose parity residual was subtracted from the
  /// record.
  int reference_repeats = 0;
  /// True if the record is itself the healthy reference, so that its leak is zero by construction.
  bool is_reference = false;
  std::optional<std::string> failure;  ///< why no leak could be fitted
  Inlined<StatedLeak> leak;
  std::optional<double> unbounded_leakage_coefficient;  ///< may be negative, see LeakFit
  bool undecided = false;                               ///< true if a leak has no class
  /// False if the leak leaves more than a third of the difference from the healthy model
  /// unexplained, which indicates another fault.
  std::optional<bool> explained_by_leak;
  /// Features of the uncorrected parity residual, eq. 14.
  metrics::ByFeature<std::optional<double>> features;
  std::optional<double> parity_rms_m, misfit_rms_m, noise_rms_m;  ///< see LeakFit
  std::optional<double> log_slope;                                ///< d ln share / d ln coefficient
  /// Class according to the paper's features, with clusters learned without this repeat, or without
  /// this signal. Absent if there is no labelled record to learn from.
  std::optional<LeakClass> class_by_features, class_by_features_of_other_signals;
  std::optional<LeakClass> true_class;
  std::optional<double> true_share_percent;
  std::vector<std::string> warnings;
  RIGCAL_DESCRIBE(condition, repeat, repeats_averaged, signal, reference_repeats, is_reference,
                  failure, leak, unbounded_leakage_coefficient, undecided, explained_by_leak,
                  features, parity_rms_m, misfit_rms_m, noise_rms_m, log_slope, class_by_features,
                  class_by_features_of_other_signals, true_class, true_share_percent, warnings)

  // Sources of the values above; not stored.

  /// True for a repeat of a healthy condition, which is corrected by the other healthy repeats.
  bool corrects_others = false;
  DayWeights days;        ///< day of the record relative to the days of its reference
  LeakFit fit;            ///< contains the reason if no leak could be fitted
  LeakEstimate estimate;  ///< valid only if fit.ok()
  /// For a healthy record whose errors are known, the smallest leak that could be detected in a
  /// record from the day of the reference, and in one from another day.
  std::optional<DetectionLimit> smallest_leak, smallest_leak_of_another_day;

  bool is_average() const { return !repeat; }
};

/// States the leak of a record that has been estimated, with its class if this can be decided, and
/// sets the warnings. The leak of a healthy reference is not stated.
///
/// @param healthy_m  RMS of the structured residual that the healthy model leaves in healthy
///                   records of the signal
void judge(RecordDiagnosis& record, const SignalErrors& errors, double healthy_m,
           const datasets::DiagnosisSettings& settings);

}  // namespace rigcal::diagnosis
