#include "metrics/significance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "metrics/distributions.hpp"

namespace rigcal::metrics {

double effective_freedom(std::span<const ErrorPart> parts) {
  double largest = 0.0;
  for (const ErrorPart& part : parts) largest = std::max(largest, part.variance);
  double sum = 0.0;
  double weighted = 0.0;
  for (const ErrorPart& part : parts) {
    const double fraction = largest > 0.0 ? part.variance / largest : 0.0;  // its square is finite
    sum += fraction;
    weighted += fraction * fraction / part.freedom;
  }
  return weighted > 0.0 ? std::clamp(sum * sum / weighted, 1.0, kManyDegrees) : kManyDegrees;
}

double freedom_of_quantile(double quantile) {
  if (!(quantile > student_t_quantile(0.975, kManyDegrees))) return kManyDegrees;
  double low = 1.0;
  double high = kManyDegrees;
  for (int i = 0; i < 60; ++i) {
    const double middle = std::sqrt(low * high);
    (student_t_quantile(0.975, middle) > quantile ? low : high) = middle;
  }
  return low;
}

EstimateError error_of_difference(const EstimateError& a, const EstimateError& b) {
  const double variance_a = a.standard_error * a.standard_error;
  const double variance_b = b.standard_error * b.standard_error;
  return {std::hypot(a.standard_error, b.standard_error),
          effective_freedom(
              std::array{ErrorPart{variance_a, a.freedom}, ErrorPart{variance_b, b.freedom}})};
}

double difference_p_value(double difference, const EstimateError& error) {
  if (!std::isfinite(difference) || !std::isfinite(error.standard_error) ||
      !(error.standard_error > 0.0) || !(error.freedom > 0.0)) {
    throw std::invalid_argument(
        "difference_p_value: expected a finite difference and a positive error");
  }
  const double score = -std::abs(difference) / error.standard_error;
  return 2.0 *
         (error.freedom < kManyDegrees ? student_t_cdf(score, error.freedom) : normal_cdf(score));
}

std::vector<double> holm(std::span<const double> p_values) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> adjusted(p_values.size());
  double least = 0.0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const double factor = static_cast<double>(order.size() - k);
    least = std::max(least, std::min(1.0, factor * p_values[order[k]]));
    adjusted[order[k]] = least;
  }
  return adjusted;
}

double sign_test_p_value(int better, int worse) {
  if (better < 0 || worse < 0) throw std::invalid_argument("sign_test_p_value: negative count");
  const int pairs = better + worse;
  if (pairs == 0) return 1.0;
  return std::min(1.0, 2.0 * binomial_cdf(std::min(better, worse), pairs, 0.5));
}

}  // namespace rigcal::metrics
