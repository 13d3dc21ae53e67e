#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "metrics/significance.hpp"

namespace rigcal::metrics {

/// A straight line through estimates with errors.
struct Trend {
  double slope = 0.0;  ///< unit of y per unit of x
  double intercept = 0.0;
  double slope_standard_error = 0.0;  ///< widened where the points lie off the line
  double freedom = 0.0;               ///< with which that error is known
  double ci95_low = 0.0;              ///< of the slope
  double ci95_high = 0.0;
  double p_value = 1.0;             ///< of no slope, two-sided
  double chi_square = 0.0;          ///< of the points about the line
  double reduced_chi_square = 0.0;  ///< over n - 2
  double widened = 1.0;             ///< factor of the error of the slope, at least 1
};

/// Line y = intercept + slope x by generalised least squares, and the test of its slope: the one
/// test of a trend that there is.
///
/// The errors of the points are known, so the slope is tested by them: by the normal distribution,
/// or Student's t where they are known with few degrees of freedom (Welch and Satterthwaite).
/// Points that scatter about the line by more than that (chi-square beyond its upper quartile, see
/// Bancroft and Han, International Statistical Review 45, 1977) show that something else differs
/// between them, such as the day: their scatter then tells the error, by Birge's ratio, the root of
/// reduced chi-square (Phys. Rev. 40, 1932), and the slope is tested by t with n - 2. Two points
/// cannot show that, so they make no trend.
///
/// @param x, y     shape (n), n >= 3
/// @param errors   of each y, independent of each other, shape (n); above 0
/// @param common   covariance of y by what moves all points together, shape (n)^2; empty: none
/// @throws std::invalid_argument  fewer points, unequal shapes, an error that is not positive, a
///                                value that is not finite
/// @throws std::domain_error      all x are equal, or errors so far from each other or from the
///                                scatter that no line follows
Trend weighted_trend(std::span<const double> x, std::span<const double> y,
                     std::span<const EstimateError> errors, const Eigen::MatrixXd& common = {});

/// Fewest points of a trend.
inline constexpr std::size_t kLeastTrendPoints = 3;

}  // namespace rigcal::metrics
