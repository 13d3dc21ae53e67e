#include "metrics/distributions.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numbers>

namespace rigcal::metrics {

double normal_quantile(double probability) {
  return boost::math::quantile(boost::math::normal(), probability);
}

// Boost computes this in long doubles, which takes ten times as long.
double normal_cdf(double x) { return 0.5 * std::erfc(-x * std::numbers::sqrt2 / 2.0); }

double student_t_quantile(double probability, double freedom) {
  // With very few degrees of freedom, a quantile exceeds every double. The result is then infinity
  // rather than an error. Long doubles would take three times as long.
  namespace policies = boost::math::policies;
  using Infinite = policies::policy<policies::overflow_error<policies::ignore_error>,
                                    policies::promote_double<false>>;
  return boost::math::quantile(boost::math::students_t_distribution<double, Infinite>(freedom),
                               probability);
}

double student_t_cdf(double t, double freedom) {
  return boost::math::cdf(boost::math::students_t(freedom), t);
}

double chi_squared_exceedance(double x, double freedom) {
  if (x == 0.0 && freedom > 0.0) return 1.0;  // Boost overflows here for many degrees of freedom
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(freedom), x));
}

double fisher_f_exceedance(double x, double numerator_freedom, double denominator_freedom) {
  const boost::math::fisher_f distribution(numerator_freedom, denominator_freedom);
  return boost::math::cdf(boost::math::complement(distribution, x));
}

double fisher_f_upper_quantile(double probability, double numerator_freedom,
                               double denominator_freedom) {
  const boost::math::fisher_f distribution(numerator_freedom, denominator_freedom);
  return boost::math::quantile(boost::math::complement(distribution, probability));
}

double binomial_cdf(int successes, int trials, double probability) {
  return boost::math::cdf(boost::math::binomial(trials, probability), successes);
}

}  // namespace rigcal::metrics
