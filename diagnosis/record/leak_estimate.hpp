#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "calib/result/uncertainty_budget.hpp"
#include "common/range.hpp"
#include "datasets/campaign/diagnosis_settings.hpp"
#include "diagnosis/record/leak_curve.hpp"
#include "diagnosis/record/leak_fit.hpp"
#include "diagnosis/record/signal_errors.hpp"

namespace rigcal::diagnosis {

/// How the day of a record differs from the days of its reference. The difference is 1 for the day
/// of the record, minus the fraction of the reference that was recorded on each day. It is zero if
/// both are from one day.
struct DayWeights {
  Eigen::VectorXd own;        ///< shape (days)
  Eigen::VectorXd reference;  ///< fraction recorded on each day, shape (days)
  Eigen::VectorXd difference() const { return own - reference; }
  double norm() const { return own.size() > 0 ? difference().norm() : 0.0; }
  /// Returns the norm of the difference for a record from a day on which no part of the reference
  /// was recorded.
  double norm_of_another_day() const { return std::sqrt(1.0 + reference.squaredNorm()); }
};

using datasets::LeakClass;
inline constexpr std::size_t kClassCount = datasets::kLeakClasses.size();

/// Estimate of the leak in one record.
struct LeakEstimate {
  double coefficient = 0.0;  ///< may be negative, see LeakFit
  /// Error of the coefficient, including the error due to rig parameters.
  double standard_error = 0.0;
  double freedom = 1.0;  ///< degrees of freedom of the standard error (Satterthwaite)
  /// 95 % interval of the coefficient, whose lower end is not negative. If no leak is detected, it
  /// extends from 0 to the upper limit, given that a leak cannot be negative. If the record is
  /// incompatible, the interval is not cut off at 0.
  Range ci95{0.0, 0.0};
  /// True if the coefficient is negative by more than its error, at the false-alarm rate in the
  /// settings. No leak explains such a record, so no leak is reported.
  bool incompatible = false;
  double share = 0.0;  ///< fraction of the servo flow, >= 0; values above 1 are impossible
  /// 95 % interval of the share, between 0 and 1, given that a leak cannot be negative. If no leak
  /// is detected, it extends from 0 to the upper limit.
  Range share_ci95{0.0, 0.0};
  /// One-sided 95 % limit; present if no leak is detected.
  std::optional<double> share_upper_limit;
  double share_slope = 0.0;  ///< d share / d coefficient
  double leak_flow_m3_per_s = 0.0;
  std::array<double, kClassCount> probability{};  ///< probability of each class
  LeakClass most_probable = LeakClass::normal;
  double leak_score = 0.0;     ///< coefficient divided by its standard error
  bool leak_detected = false;  ///< at the false-alarm rate in the settings
  calib::Budget95 budget;      ///< contributions to `standard_error`
  /// Contributions to the standard error of the share, to first order, in percentage points.
  calib::Budget95 share_budget;

  /// Returns true if the share is possible: the leak cannot exceed the servo flow.
  bool has_share() const { return share <= 1.0; }
  /// Returns true if the leak can be given a class.
  bool has_class() const { return !incompatible && has_share(); }
};

/// Error of the coefficient for one record. It combines independent contributions: the residuals
/// (with clusters if the signal has a lack of fit that the record shows), the variation between
/// repeats beyond their white noise (for an average, divided by the square root of their number),
/// the apparent leak of healthy records, the rig's parameters, and day-to-day differences.
struct CoefficientError {
  double own_se = 0.0;  ///< standard error without the contributions of rig parameters and days
  double rig_se = 0.0;
  double freedom = 1.0;  ///< Welch-Satterthwaite degrees of freedom
  /// Standard error due to differences between the day of the record and the days of its reference
  /// (with_days()).
  double days_se = 0.0;
  std::vector<calib::BudgetLine> own = {};  ///< contributions to own_se
  double total() const;
  /// Returns the half-width of the 95 % interval.
  double half_width() const;
};

/// @param repeats    number of repeats averaged in the record
/// @param reference  number of healthy repeats that correct the record; 0 if it is not corrected
CoefficientError coefficient_error(const LeakFit& fit, const SignalErrors& errors, int repeats,
                                   int reference);

/// Returns the error for an average that is its own reference: that of the difference between a
/// mean of `repeats` repeats and a mean of `reference` repeats. The noise of the single repeats,
/// the misfit of other records and the variation between repeats beyond noise contribute. Returns
/// std::nullopt if there is only one repeat.
std::optional<CoefficientError> error_of_averages(const LeakFit& fit, const SignalErrors& errors,
                                                  int repeats, int reference);

/// Computes the interval, share and class probabilities for one record.
///
/// The coefficient has a t distribution around its estimate. Given that it is not negative, the
/// curve converts it to a share, to which the error due to the rig's parameters is added. For the
/// classes, the prior probability of a share decreases with its size, such that a normal machine is
/// as probable as one with a slight leak.
///
/// @param curve         curve around the estimate
/// @param share_rig_se  standard error of the share due to the rig's parameters
LeakEstimate estimate_leak(double coefficient, const CoefficientError& error,
                           const LeakCurve& curve, double share_rig_se,
                           const datasets::DiagnosisSettings& settings);

/// The smallest detectable leak (Currie's detection limit, Anal. Chem. 40, 1968). A leak of this
/// size is found in the fraction `detection` of cases, while at most the fraction `false_alarms` of
/// records without a leak are mistaken for leaking. Both are settings.
struct DetectionLimit {
  double coefficient = 0.0;
  double leak_flow_m3_per_s = 0.0;
  double share = 0.0;
};

/// Returns the coefficient of the smallest detectable leak.
///
/// @param healthy  error of the coefficient in a record without a leak
double detection_limit(const CoefficientError& healthy,
                       const datasets::DiagnosisSettings& settings);

/// Replaces `kept` with `limit` if the flow of `limit` is larger.
void keep_larger(const DetectionLimit& limit, std::optional<DetectionLimit>& kept);

}  // namespace rigcal::diagnosis
