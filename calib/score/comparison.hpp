#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calib/result/estimate_spread.hpp"
#include "calib/result/fitted_parameter.hpp"
#include "common/describe.hpp"
#include "metrics/significance.hpp"

// Whether the numbers of two results differ beyond their errors, and whether those of several
// results change along a date or a temperature.

namespace rigcal::calib {

/// Significance level of every test in a comparison.
inline constexpr double kSignificantLevel = 0.05;

/// Reason of a difference between values that neither result estimates.
inline constexpr const char* kKnownInBoth = "known in both";

/// A parameter in one of the results that are compared, SI.
struct ComparedEstimate {
  std::optional<double> value;
  bool fitted = false;
  std::optional<double> standard_error;
  Later<std::optional<double>> degrees_of_freedom;  ///< for the standard error
  std::optional<Range> ci95;
  std::optional<Identifiability> identifiability;
  bool at_bound = false;
  Omittable<double> between_days_error;  ///< standard error by what differs between days
  RIGCAL_DESCRIBE(value, fitted, standard_error, degrees_of_freedom, ci95, identifiability,
                  at_bound, between_days_error)
};

/// An estimate minus that of the first result.
struct EstimateDifference {
  std::optional<double> difference;
  std::optional<double> percent;  ///< absent where the first value may be zero
  std::optional<double> standard_error;
  Later<std::optional<double>> degrees_of_freedom;  ///< for this error (Welch and Satterthwaite)
  std::optional<double> p_value;                    ///< for this parameter alone
  std::optional<double> p_value_of_all;             ///< adjusted for all parameters (Holm)
  std::optional<bool> significant;
  std::optional<std::string> reason;  ///< why it is not tested
  Omittable<bool> of_other_dates;     ///< the error includes what differs between days
  /// Part of the error due to small effects that both models leave out.
  Omittable<double> by_effects;
  RIGCAL_DESCRIBE(difference, percent, standard_error, degrees_of_freedom, p_value, p_value_of_all,
                  significant, reason, of_other_dates, by_effects)
};

/// What decides how two results may be tested against each other.
struct Dependence {
  bool same_records = false;  ///< both were fitted to common data
  bool other_dates = false;   ///< they are stated to be of different dates
  double by_effects = 0.0;    ///< variance of the difference by effects, see variance_by_effects()
};

/// The difference, except for the adjustment that needs all parameters together.
EstimateDifference difference_of(const ComparedEstimate& first, const ComparedEstimate& other,
                                 const Dependence& dependence);

/// Judges the differences of all parameters together; those without a p-value are left out.
void judge_together(const std::vector<EstimateDifference*>& differences);

/// Variance that the effects which both models leave out give the difference of two estimates of
/// one rig: the effects are the same in both, and what they move both estimates by cancels. By the
/// size that either result leaves them.
///
/// @param first, other  of one estimate each
double variance_by_effects(const EffectSpread& first, const EffectSpread& other);

/// The error of an estimate with that by what differs between days.
metrics::EstimateError with_days(const metrics::EstimateError& own,
                                 const std::optional<double>& between_days_error);

/// Means of a score over the conditions that two results have, and in how many the other is the
/// better.
struct ScoreDifference {
  int conditions = 0;
  double mean_of_first = 0.0, mean = 0.0;
  int better = 0, worse = 0;
  std::optional<double> p_value;
  std::optional<bool> significant;
  std::optional<std::string> reason;  ///< why it is not tested
  RIGCAL_DESCRIBE(conditions, mean_of_first, mean, better, worse, p_value, significant, reason)
};

/// @param scores  of the first result and of the other, a pair for each condition; at least one
/// @param shared  whether the results share records, so that a sign test means nothing
ScoreDifference score_difference(const std::vector<std::pair<double, double>>& scores,
                                 bool higher_is_better, bool shared);

/// A line through estimates, weighted by their errors.
struct EstimateTrend {
  long points = 0;  ///< with an error and a position
  std::optional<double> slope, intercept, standard_error;
  Later<std::optional<double>> degrees_of_freedom;  ///< for the slope's error
  Later<std::optional<double>> widened;  ///< factor on that error by scatter about the line
  std::optional<Range> ci95;
  std::optional<double> p_value, reduced_chi_square;
  std::optional<bool> significant;
  std::optional<std::string> reason;  ///< why there is no line
};

/// One estimate of a series.
struct PlacedEstimate {
  double place = 0.0;
  double value = 0.0;
  metrics::EstimateError error;
};

/// @param shared  whether results of the series share records
EstimateTrend trend_of(const std::vector<PlacedEstimate>& estimates, bool shared);

}  // namespace rigcal::calib
