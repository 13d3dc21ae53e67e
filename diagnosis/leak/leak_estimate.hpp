#pragma once

#include <array>
#include <optional>
#include <utility>

#include "common/range.hpp"
#include "datasets/campaign/diagnosis_settings.hpp"
#include "diagnosis/leak/leak_curve.hpp"
#include "diagnosis/leak/leak_fit.hpp"
#include "diagnosis/leak/signal_errors.hpp"

namespace rigcal::diagnosis {

using datasets::LeakClass;
inline constexpr std::size_t kClassCount = datasets::kLeakClasses.size();

/// Estimate of the leak in one record.
struct LeakEstimate {
  double coefficient = 0.0;     ///< signed, see LeakFit
  double standard_error = 0.0;  ///< error of the coefficient, rig parameters included
  double freedom = 1.0;         ///< degrees of freedom of the standard error (Satterthwaite)
  /// 95 % interval of the coefficient, with its lower end at 0 or above. If no leak is detected it
  /// goes from 0 to the upper limit, given that a leak is not negative. It is not cut at 0 if the
  /// record is incompatible.
  Range ci95{0.0, 0.0};
  /// The coefficient is negative beyond its error, at the settings' rate of false alarms. No leak
  /// explains such a record, so no leak is reported.
  bool incompatible = false;
  double share = 0.0;  ///< fraction of the servo flow, >= 0; above 1 it is impossible
  /// 95 % interval of the share within 0 and 1, given that a leak is not negative. If no leak is
  /// detected it goes from 0 to the upper limit.
  Range share_ci95{0.0, 0.0};
  /// One-sided limit at 95 % where no leak is detected.
  std::optional<double> share_upper_limit;
  double share_slope = 0.0;  ///< d share / d coefficient
  double leak_flow_m3_per_s = 0.0;
  std::array<double, kClassCount> probability{};  ///< probability of each class
  LeakClass most_probable = LeakClass::normal;
  double leak_score = 0.0;     ///< coefficient over its standard error
  bool leak_detected = false;  ///< at the settings' rate of false alarms

  /// Whether the share is possible: no more than the whole servo flow can leak.
  bool has_share() const { return share <= 1.0; }
  /// Whether the leak has a class.
  bool has_class() const { return !incompatible && has_share(); }
};

/// Error of the coefficient of one record, from independent parts: the residuals (by clusters
/// if the signal has a lack of fit and the record shows it), variation between repeats beyond their
/// white noise (divided by the root of their number for an average), the apparent leak of healthy
/// records, the rig's parameters, and the days.
struct CoefficientError {
  double own_se = 0.0;  ///< without the rig's parameters and the days
  double rig_se = 0.0;
  double freedom = 1.0;  ///< Welch and Satterthwaite
  /// From what differs between the day of the record and that of its reference (with_days()).
  double days_se = 0.0;
  double total() const;
  /// Half the width of the 95 % interval.
  double half_width() const;
};

/// @param repeats    how many the record is the mean of
/// @param reference  how many healthy repeats correct it; 0: none
CoefficientError coefficient_error(const LeakFit& fit, const SignalErrors& errors, int repeats,
                                   int reference);

/// Error of an average that is its own reference, from the variation between single repeats. It is
/// the error of the difference between two means: one of `repeats`, one of `reference` repeats.
/// Nothing if there is a single repeat.
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

/// The smallest detectable leak: it is found in the settings' fraction of cases (`detection`), with
/// at most `false_alarms` of records without a leak taken for leaking (Currie's detection limit,
/// Anal. Chem. 40, 1968).
struct DetectionLimit {
  double coefficient = 0.0;
  double leak_flow_m3_per_s = 0.0;
  double share = 0.0;
};

/// Coefficient of the smallest leak.
///
/// @param healthy  error of the coefficient for a record without a leak
double detection_limit(const CoefficientError& healthy,
                       const datasets::DiagnosisSettings& settings);

/// Keeps the limit that takes the larger flow to be seen.
void keep_larger(const DetectionLimit& limit, std::optional<DetectionLimit>& kept);

}  // namespace rigcal::diagnosis
