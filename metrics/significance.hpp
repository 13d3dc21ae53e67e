#pragma once

#include <span>
#include <vector>

namespace rigcal::metrics {

/// Number of degrees of freedom from which Student's t is treated as the normal distribution.
inline constexpr double kManyDegrees = 1e6;

/// Standard error of an estimate, with its degrees of freedom.
struct EstimateError {
  double standard_error = 0.0;
  double freedom = kManyDegrees;
};

/// One of several independent contributions to a variance.
struct ErrorPart {
  double variance = 0.0;
  double freedom = kManyDegrees;
};

/// Effective degrees of freedom of a sum of variances: (sum v)^2 / sum (v^2 / freedom) (B. L.
/// Welch, Biometrika 34, 1947), at least 1 and at most kManyDegrees.
double effective_freedom(std::span<const ErrorPart> parts);

/// Degrees of freedom, from 1 to kManyDegrees, for which the 97.5 % quantile of Student's t has
/// this value.
double freedom_of_quantile(double quantile);

/// Error of the difference between two independent estimates.
EstimateError error_of_difference(const EstimateError& a, const EstimateError& b);

/// Two-sided probability of finding a difference of at least this size if there is no true
/// difference. Uses Student's t with the degrees of freedom of the error, and the normal
/// distribution from kManyDegrees on.
///
/// @param error  error of the difference, in the same unit; > 0
/// @throws std::invalid_argument  if the error or its degrees of freedom are not positive, or if a
///                                value is not finite
double difference_p_value(double difference, const EstimateError& error);

/// Adjusts p-values for testing all of them together: the k-th smallest of n becomes (n - k + 1) p,
/// but never less than the adjusted value of a smaller one (S. Holm, Scand. J. Statist. 6, 1979).
///
/// @param p_values  shape (n), in [0, 1]
/// @return shape (n), in the same order
std::vector<double> holm(std::span<const double> p_values);

/// Two-sided exact sign test: the probability of a split at least this uneven among `better` +
/// `worse` pairs if both outcomes are equally likely. Ties must be left out. Returns 1 if there are
/// no pairs.
///
/// @throws std::invalid_argument  if a count is negative
double sign_test_p_value(int better, int worse);

/// Minimum number of pairs for a sign test at the 5 % level. Six pairs can reach
/// p = 2 / 2^6 = 0.031, five only 2 / 2^5 = 0.063.
inline constexpr int kLeastSignPairs = 6;

}  // namespace rigcal::metrics
