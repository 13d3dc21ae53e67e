#include "metrics/significance.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "metrics/distributions.hpp"

namespace rigcal::metrics {

double difference_p_value(double difference, double standard_error) {
  if (!std::isfinite(difference) || !std::isfinite(standard_error) || !(standard_error > 0.0)) {
    throw std::invalid_argument(
        "difference_p_value: expected a finite difference and a positive error");
  }
  return 2.0 * normal_cdf(-std::abs(difference) / standard_error);
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

Trend weighted_trend(std::span<const double> x, std::span<const double> y,
                     std::span<const double> standard_error) {
  const std::size_t n = x.size();
  if (n < 3 || y.size() != n || standard_error.size() != n)
    throw std::invalid_argument("weighted_trend: expected three points or more, of equal shapes");
  double weights = 0.0;
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i]) || !(standard_error[i] > 0.0) ||
        !std::isfinite(standard_error[i]))
      throw std::invalid_argument("weighted_trend: expected finite values and positive errors");
    const double w = 1.0 / (standard_error[i] * standard_error[i]);
    weights += w;
    mean_x += w * x[i];
    mean_y += w * y[i];
  }
  mean_x /= weights;
  mean_y /= weights;
  double sxx = 0.0;
  double sxy = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double w = 1.0 / (standard_error[i] * standard_error[i]);
    sxx += w * (x[i] - mean_x) * (x[i] - mean_x);
    sxy += w * (x[i] - mean_x) * (y[i] - mean_y);
  }
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  if (*low == *high) throw std::domain_error("weighted_trend: all x are equal");
  Trend trend;
  trend.slope = sxy / sxx;
  trend.intercept = mean_y - trend.slope * mean_x;
  double chi_square = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double off = (y[i] - trend.intercept - trend.slope * x[i]) / standard_error[i];
    chi_square += off * off;
  }
  const double freedom = static_cast<double>(n - 2);
  trend.reduced_chi_square = chi_square / freedom;
  trend.slope_standard_error = std::sqrt(std::max(1.0, trend.reduced_chi_square) / sxx);
  const double half = student_t_quantile(0.975, freedom) * trend.slope_standard_error;
  trend.ci95_low = trend.slope - half;
  trend.ci95_high = trend.slope + half;
  trend.p_value = 2.0 * student_t_cdf(-std::abs(trend.slope) / trend.slope_standard_error, freedom);
  return trend;
}

}  // namespace rigcal::metrics
