#pragma once

#include <array>
#include <optional>
#include <utility>

#include "datasets/diagnosis_settings.hpp"
#include "diagnosis/leak_curve.hpp"
#include "diagnosis/leak_fit.hpp"
#include "diagnosis/signal_errors.hpp"

namespace rigcal::diagnosis {

using datasets::LeakClass;
inline constexpr std::size_t kClassCount = datasets::kLeakClasses.size();

/// What is known of the leak in one record.
struct LeakEstimate {
  double coefficient = 0.0;                  ///< signed, see LeakFit
  double standard_error = 0.0;               ///< of it, rig parameters included
  double freedom = 1.0;                      ///< degrees of freedom of that error (Satterthwaite)
  std::pair<double, double> ci95{0.0, 0.0};  ///< of the coefficient, cut at 0
  double share = 0.0;                        ///< fraction of the servo flow, >= 0
  std::pair<double, double> share_ci95{0.0, 0.0};  ///< given that a leak is not negative
  double leak_flow_m3_per_s = 0.0;
  std::array<double, kClassCount> probability{};  ///< of each class
  LeakClass most_probable = LeakClass::normal;
  double leak_score = 0.0;     ///< coefficient over its standard error
  bool leak_detected = false;  ///< at the settings' rate of false alarms
};

/// Interval, share and class probabilities of one record.
///
/// Independent errors of the coefficient: scatter of the residuals, variation between repeats (over
/// the root of their number for an average), the leak that healthy records seem to have, and the
/// rig's parameters. The coefficient is t-distributed about its estimate; given that it is not
/// negative, the curve of the condition turns it into a share, to which the error of the rig's
/// parameters is added. For the classes, a normal machine is beforehand as probable as one with a
/// slight leak; else every share as any other.
///
/// @param repeats    how many the record is the mean of
/// @param reference  how many healthy repeats correct it; 0: none
LeakEstimate estimate_leak(const LeakFit& fit, const LeakCurve& curve, const SignalErrors& errors,
                           int repeats, int reference, const datasets::DiagnosisSettings& settings);

/// The smallest leak that is told from none: found in the settings' share of cases (`detection`)
/// where no leak is taken for one in no more than `false_alarms` of them (Currie's detection limit,
/// Anal. Chem. 40, 1968).
struct DetectionLimit {
  double coefficient = 0.0;
  double leak_flow_m3_per_s = 0.0;
  double share = 0.0;
};

/// @param healthy  estimate of a record without a leak
DetectionLimit detection_limit(const LeakEstimate& healthy, const LeakCurve& curve,
                               const datasets::DiagnosisSettings& settings);

/// Keeps the limit that takes the larger flow to be seen.
void keep_larger(const DetectionLimit& limit, std::optional<DetectionLimit>& kept);

}  // namespace rigcal::diagnosis
