#pragma once

// Boost's distributions in one place: their headers take longer to compile than the code that calls
// them.

namespace rigcal::metrics {

/// Half width of a 95 % interval in standard errors, for many degrees of freedom.
inline constexpr double kNormal95 = 1.96;
/// Significance level of a test whose result warns: one false alarm in twenty.
inline constexpr double kWarningLevel = 0.05;

/// Quantile of the standard normal distribution.
///
/// @param probability  in [0, 1]
/// @throws std::domain_error  outside [0, 1]
/// @throws std::overflow_error  0 or 1
double normal_quantile(double probability);

/// Probability that a standard normal variable is below x.
double normal_cdf(double x);

/// Student's t with `freedom` degrees of freedom > 0, not necessarily whole. A quantile above the
/// largest double is returned as infinity.
///
/// @throws std::domain_error  invalid probability or degrees of freedom
double student_t_quantile(double probability, double freedom);
double student_t_cdf(double t, double freedom);

/// Probability that chi-square with `freedom` degrees of freedom > 0 exceeds x >= 0.
///
/// @throws std::domain_error  invalid x or degrees of freedom
double chi_squared_exceedance(double x, double freedom);

/// Probability that Fisher's F with these degrees of freedom > 0 exceeds x >= 0.
///
/// @throws std::domain_error  invalid x or degrees of freedom
double fisher_f_exceedance(double x, double numerator_freedom, double denominator_freedom);

/// Value that Fisher's F exceeds with a probability.
///
/// @param probability  in (0, 1)
/// @throws std::domain_error  invalid probability or degrees of freedom
double fisher_f_upper_quantile(double probability, double numerator_freedom,
                               double denominator_freedom);

/// Probability of at most `successes` in `trials` >= 0 that each succeed with `probability`.
///
/// @throws std::domain_error  no such count or probability
double binomial_cdf(int successes, int trials, double probability);

}  // namespace rigcal::metrics
