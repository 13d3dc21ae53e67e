#pragma once

// Collects Boost's distributions in one place, because their headers take longer to compile than
// the code that calls them.

namespace rigcal::metrics {

/// Half width of a 95 % interval, in standard errors, for many degrees of freedom.
inline constexpr double kNormal95 = 1.96;
/// Significance level of the tests that cause warnings: one false alarm in twenty.
inline constexpr double kWarningLevel = 0.05;

/// Quantile of the standard normal distribution.
///
/// @param probability  in [0, 1]
/// @throws std::domain_error    if the probability is outside [0, 1]
/// @throws std::overflow_error  if the probability is 0 or 1
double normal_quantile(double probability);

/// Probability that a standard normal variable is below x.
double normal_cdf(double x);

/// Quantile and distribution function of Student's t with `freedom` degrees of freedom > 0, not
/// necessarily a whole number. A quantile above the largest double is returned as infinity.
///
/// @throws std::domain_error  if the probability or the degrees of freedom are invalid
double student_t_quantile(double probability, double freedom);
double student_t_cdf(double t, double freedom);

/// Probability that chi-square with `freedom` degrees of freedom > 0 exceeds x >= 0.
///
/// @throws std::domain_error  if x or the degrees of freedom are invalid
double chi_squared_exceedance(double x, double freedom);

/// Probability that an F-distributed variable exceeds x >= 0. The degrees of freedom must be
/// positive.
///
/// @throws std::domain_error  if x or the degrees of freedom are invalid
double fisher_f_exceedance(double x, double numerator_freedom, double denominator_freedom);

/// Value that Fisher's F exceeds with the given probability.
///
/// @param probability  in (0, 1)
/// @throws std::domain_error  if the probability or the degrees of freedom are invalid
double fisher_f_upper_quantile(double probability, double numerator_freedom,
                               double denominator_freedom);

/// Probability of at most `successes` in `trials` >= 0 trials, each of which succeeds with
/// `probability`.
///
/// @throws std::domain_error  if a count or the probability is invalid
double binomial_cdf(int successes, int trials, double probability);

}  // namespace rigcal::metrics
