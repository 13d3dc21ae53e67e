#pragma once

#include <array>
#include <optional>
#include <utility>

#include "datasets/campaign/diagnosis_settings.hpp"
#include "diagnosis/leak/leak_curve.hpp"
#include "diagnosis/leak/leak_fit.hpp"
#include "diagnosis/leak/signal_errors.hpp"

namespace rigcal::diagnosis {

using datasets::LeakClass;
inline constexpr std::size_t kClassCount = datasets::kLeakClasses.size();

/// What is known of the leak in one record.
struct LeakEstimate {
  double coefficient = 0.0;     ///< signed, see LeakFit
  double standard_error = 0.0;  ///< of it, rig parameters included
  double freedom = 1.0;         ///< degrees of freedom of that error (Satterthwaite)
  /// Of the coefficient, cut at 0 from below; where no leak is detected, from 0 to the upper limit
  /// at 95 %, given that a leak is not negative. Not cut where it is incompatible.
  std::pair<double, double> ci95{0.0, 0.0};
  /// The coefficient lies below zero by more than its error allows, at the settings' rate of false
  /// alarms: no leak makes such a record, so nothing is said of one.
  bool incompatible = false;
  double share = 0.0;  ///< fraction of the servo flow, >= 0; above 1 none that can be
  /// Given that a leak is not negative, within 0 and 1; where none is detected, from 0 to the upper
  /// limit.
  std::pair<double, double> share_ci95{0.0, 0.0};
  /// One-sided limit at 95 % where no leak is detected.
  std::optional<double> share_upper_limit;
  double share_slope = 0.0;  ///< d share / d coefficient
  double leak_flow_m3_per_s = 0.0;
  std::array<double, kClassCount> probability{};  ///< of each class
  LeakClass most_probable = LeakClass::normal;
  double leak_score = 0.0;     ///< coefficient over its standard error
  bool leak_detected = false;  ///< at the settings' rate of false alarms

  /// Whether the share is one: more than the servo flow cannot leak of it.
  bool has_share() const { return share <= 1.0; }
  /// Whether it may be put into a class.
  bool has_class() const { return !incompatible && has_share(); }
};

/// Error of the coefficient of one record: four parts that are independent of each other, scatter
/// of the residuals (by clusters where the signal has misfit and the record shows it), variation
/// between repeats beyond their white noise (over the root of their number for an average), the
/// leak that healthy records seem to have, and the rig's parameters.
struct CoefficientError {
  double own_se = 0.0;  ///< without the rig's parameters
  double rig_se = 0.0;
  double freedom = 1.0;  ///< Welch and Satterthwaite
  double total() const;
  /// Half the width of the 95 % interval.
  double half_width() const;
};

/// @param repeats    how many the record is the mean of
/// @param reference  how many healthy repeats correct it; 0: none
CoefficientError coefficient_error(const LeakFit& fit, const SignalErrors& errors, int repeats,
                                   int reference);

/// The error of an average that is its own reference, from the spread between single repeats: of
/// the difference between the mean of so many and that of as many as the reference has. Nothing
/// where there are no repeats.
std::optional<CoefficientError> error_of_averages(const LeakFit& fit, const SignalErrors& errors,
                                                  int repeats, int reference);

/// Interval, share and class probabilities of one record.
///
/// The coefficient is t-distributed about its estimate; given that it is not negative, the curve
/// turns it into a share, to which the error of the rig's parameters is added. For the classes, a
/// share is beforehand the less probable the larger it is, and a normal machine as probable as one
/// with a slight leak.
///
/// @param curve         about the estimate
/// @param share_rig_se  standard error of the share from the rig's parameters
LeakEstimate estimate_leak(double coefficient, const CoefficientError& error,
                           const LeakCurve& curve, double share_rig_se,
                           const datasets::DiagnosisSettings& settings);

/// The smallest leak that is told from none: found in the settings' share of cases (`detection`)
/// where no leak is taken for one in no more than `false_alarms` of them (Currie's detection limit,
/// Anal. Chem. 40, 1968).
struct DetectionLimit {
  double coefficient = 0.0;
  double leak_flow_m3_per_s = 0.0;
  double share = 0.0;
};

/// Coefficient of the smallest leak.
///
/// @param healthy  error of the coefficient of a record without a leak
double detection_limit(const CoefficientError& healthy,
                       const datasets::DiagnosisSettings& settings);

/// Keeps the limit that takes the larger flow to be seen.
void keep_larger(const DetectionLimit& limit, std::optional<DetectionLimit>& kept);

}  // namespace rigcal::diagnosis
