#pragma once

#include <span>
#include <vector>

namespace rigcal::metrics {

/// Two-sided probability of a difference this large between two independent estimates that do not
/// differ: 2 Phi(-|difference| / standard_error).
///
/// @param standard_error  of the difference, same unit, > 0
/// @throws std::invalid_argument  it is not, or a value is not finite
double difference_p_value(double difference, double standard_error);

/// p-values that hold for all of them together: of the k-th smallest of n, (n - k + 1) p, never
/// below that of a smaller one (S. Holm, Scand. J. Statist. 6, 1979).
///
/// @param p_values  shape (n), in [0, 1]
/// @return shape (n), in the same order
std::vector<double> holm(std::span<const double> p_values);

/// Two-sided exact sign test: the probability that of `better` + `worse` pairs at least as many
/// fall on one side if each side is equally likely. Ties are left out before. 1 without pairs.
///
/// @throws std::invalid_argument  a count is negative
double sign_test_p_value(int better, int worse);

/// Fewest pairs with which a sign test can reach the 5 % level: 2 / 2^6 = 0.031, 2 / 2^5 = 0.063.
inline constexpr int kLeastSignPairs = 6;

/// A straight line through estimates with standard errors, by weighted least squares.
struct Trend {
  double slope = 0.0;  ///< unit of y per unit of x
  double intercept = 0.0;
  double slope_standard_error = 0.0;
  double ci95_low = 0.0;  ///< of the slope, by the t distribution with n - 2 degrees of freedom
  double ci95_high = 0.0;
  double p_value = 1.0;             ///< of no slope, two-sided
  double reduced_chi_square = 0.0;  ///< of the points about the line; n - 2 degrees of freedom
};

/// Line y = intercept + slope x with weights 1 / standard_error^2. Where the points scatter more
/// than their errors say, the error of the slope is widened by the root of reduced chi-square.
///
/// @param x, y, standard_error  shape (n), n >= 3; errors > 0
/// @throws std::invalid_argument  fewer points, unequal shapes, an error that is not positive, a
///                                value that is not finite
/// @throws std::domain_error      all x are equal
Trend weighted_trend(std::span<const double> x, std::span<const double> y,
                     std::span<const double> standard_error);

}  // namespace rigcal::metrics
