#pragma once

#include <Eigen/Core>
#include <span>

#include "metrics/significance.hpp"

namespace rigcal::metrics {

/// A straight line fitted to estimates with errors.
struct Trend {
  double slope = 0.0;  ///< unit of y per unit of x
  double intercept = 0.0;
  double slope_standard_error = 0.0;  ///< widened if the points are too far from the line
  double freedom = 0.0;               ///< degrees of freedom of that error
  double ci95_low = 0.0;              ///< ends of the slope's 95 % interval
  double ci95_high = 0.0;
  double p_value = 1.0;             ///< two-sided, for the hypothesis of no slope
  double chi_square = 0.0;          ///< squared distances from the line over variances
  double reduced_chi_square = 0.0;  ///< chi-square divided by n - 2
  double widened = 1.0;             ///< factor on the error of the slope, at least 1
};

/// Differences between the days of the points of a trend, such as those of supply and oil.
struct DaysOfPoints {
  /// Whether the errors of all points, or `covariance`, contain these differences.
  bool counted = false;
  /// Covariance of y due to the days, in addition to the errors of the points, shape (n, n); empty
  /// if there is none.
  Eigen::MatrixXd covariance;
  double freedom = kManyDegrees;  ///< degrees of freedom of that covariance
};

/// Fits the line y = intercept + slope x by generalised least squares and tests its slope. All
/// trends are tested with this function.
///
/// The errors of the points are known, so the test is based on them. It uses the normal
/// distribution, or Student's t if they have few degrees of freedom (Welch and Satterthwaite). If
/// the points are farther from the line than their errors explain, something else differs between
/// them. The error is then based on these distances, using Birge's ratio, the square root of
/// reduced chi-square (Phys. Rev. 40, 1932), and the slope is tested by t with n - 2 degrees of
/// freedom. Two points are always on a line, so they do not make a trend.
///
/// If the differences between days are not counted, the points are expected to be farther from
/// the line than their errors explain. Chi-square then decides at its upper quartile (Bancroft and
/// Han, International Statistical Review 45, 1977). If they are counted, it decides at 10 %, which
/// finds more trends (decision 58).
///
/// @param x, y     shape (n), n >= 3
/// @param errors   error of each y, independent of the others, shape (n); above 0
/// @param common   covariance of y due to causes that affect all points, shape (n, n), taken as
///                 exactly known; empty if there are no such causes
/// @param days     differences between the days of the points
/// @throws std::invalid_argument  if there are fewer points, shapes differ, an error is not
///                                positive, or a value is not finite
/// @throws std::domain_error      if all x are equal, or if the errors differ so much from each
///                                other or from the distances that no line can be fitted
Trend weighted_trend(std::span<const double> x, std::span<const double> y,
                     std::span<const EstimateError> errors, const Eigen::MatrixXd& common = {},
                     const DaysOfPoints& days = {});

/// Minimum number of points in a trend.
inline constexpr std::size_t kLeastTrendPoints = 3;

}  // namespace rigcal::metrics
