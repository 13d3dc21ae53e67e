#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calib/result/estimate_covariance.hpp"
#include "calib/result/fitted_parameter.hpp"
#include "common/describe.hpp"
#include "metrics/significance.hpp"

// Tests whether the estimates of two results differ by more than their errors, and whether the
// estimates of several results show a trend over date or temperature.

namespace rigcal::calib {

/// Significance level of every test in a comparison.
inline constexpr double kSignificantLevel = 0.05;

/// Reason for not testing a difference between values that neither result estimates.
inline constexpr const char* kKnownInBoth = "known in both";

/// A parameter in one of the compared results, SI.
struct ComparedEstimate {
  std::optional<double> value;
  bool fitted = false;
  std::optional<double> standard_error;
  Later<std::optional<double>> degrees_of_freedom;  ///< degrees of freedom of the standard error
  std::optional<Range> ci95;
  std::optional<Identifiability> identifiability;
  bool at_bound = false;
  Omittable<double> between_days_error;  ///< standard error due to day-to-day differences
  RIGCAL_DESCRIBE(value, fitted, standard_error, degrees_of_freedom, ci95, identifiability,
                  at_bound, between_days_error)
};

/// Difference between an estimate and that of the first result.
struct EstimateDifference {
  std::optional<double> difference;
  std::optional<double> percent;  ///< absent if the first estimate may be zero
  std::optional<double> standard_error;
  /// Degrees of freedom of this error (Welch and Satterthwaite).
  Later<std::optional<double>> degrees_of_freedom;
  std::optional<double> p_value;         ///< p-value of the test for this parameter only
  std::optional<double> p_value_of_all;  ///< p-value adjusted for all parameters (Holm)
  std::optional<bool> significant;
  std::optional<std::string> reason;  ///< why it is not tested
  Omittable<bool> of_other_dates;     ///< true if the error includes day-to-day differences
  /// Component of the error that is due to small effects which both models omit.
  Omittable<double> by_effects;
  RIGCAL_DESCRIBE(difference, percent, standard_error, degrees_of_freedom, p_value, p_value_of_all,
                  significant, reason, of_other_dates, by_effects)
};

/// How two results depend on each other, which decides how their difference is tested.
struct Dependence {
  bool same_records = false;  ///< true if records were used in both fits
  bool other_dates = false;   ///< true if the campaigns state different dates
  double by_effects = 0.0;    ///< variance of the difference, from variance_by_effects()
};

/// Computes and tests the difference between two estimates. judge_together() then adjusts the
/// p-value for all parameters.
EstimateDifference difference_of(const ComparedEstimate& first, const ComparedEstimate& other,
                                 const Dependence& dependence);

/// Adjusts the p-values for all parameters, and decides which differences are significant. Skips
/// differences without a p-value.
void judge_together(const std::vector<EstimateDifference*>& differences);

/// Returns the variance of the difference between two estimates for the same rig that is due to the
/// effects which the models omit. The effects are the same for both results, so any change that
/// they cause in both estimates cancels. Returns the larger of the two variances that follow from
/// the effect sizes in either result.
///
/// @param first, other each must have exactly one estimate
double variance_by_effects(const EffectCovariance& first, const EffectCovariance& other);

/// Adds the error due to day-to-day differences to the error of an estimate.
metrics::EstimateError with_days(const metrics::EstimateError& own,
                                 const std::optional<double>& between_days_error);

/// Means of a score over the conditions that two results have in common, and the numbers of
/// conditions in which the other result is better or worse.
struct ScoreDifference {
  int conditions = 0;
  double mean_of_first = 0.0, mean = 0.0;
  int better = 0, worse = 0;
  std::optional<double> p_value;
  std::optional<bool> significant;
  std::optional<std::string> reason;  ///< why it is not tested
  RIGCAL_DESCRIBE(conditions, mean_of_first, mean, better, worse, p_value, significant, reason)
};

/// @param scores  for each condition, the score in the first and in the other result; not empty
/// @param shared  whether the results share records, which makes a sign test meaningless
ScoreDifference score_difference(const std::vector<std::pair<double, double>>& scores,
                                 bool higher_is_better, bool shared);

/// A straight line fitted to estimates that are weighted according to their errors.
struct EstimateTrend {
  long points = 0;  ///< number of estimates that have an error and a position
  std::optional<double> slope, intercept, standard_error;
  /// Degrees of freedom of the slope's standard error.
  Later<std::optional<double>> degrees_of_freedom;
  /// Factor by which variation about the line widens that error.
  Later<std::optional<double>> widened;
  std::optional<Range> ci95;
  std::optional<double> p_value, reduced_chi_square;
  std::optional<bool> significant;
  std::optional<std::string> reason;  ///< why there is no line
};

/// One estimate in a series; `place` is its date or temperature.
struct PlacedEstimate {
  double place = 0.0;
  double value = 0.0;
  metrics::EstimateError error;
  bool days_counted = false;  ///< whether the error includes day-to-day differences
};

/// Fits a line to a series of estimates, and tests its slope. The test relies on the errors more
/// than on the variation about the line if every error includes day-to-day differences
/// (metrics::weighted_trend()).
///
/// @param shared  whether results in the series share records
EstimateTrend trend_of(const std::vector<PlacedEstimate>& estimates, bool shared);

/// Returns the half-width of the 95 % band about the line of a trend, in the unit of the
/// estimates. The level of the line at the weighted mean abscissa has its own error, which is
/// independent of that of the slope. Returns std::nullopt if there is no line.
///
/// @param estimates  those that trend_of() was given
std::optional<double> half_width_of_band(const EstimateTrend& trend,
                                         const std::vector<PlacedEstimate>& estimates,
                                         double place);

}  // namespace rigcal::calib
