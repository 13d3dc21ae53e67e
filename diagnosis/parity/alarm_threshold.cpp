#include "diagnosis/parity/alarm_threshold.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "metrics/distributions.hpp"

namespace rigcal::diagnosis {

std::optional<double> alarm_threshold(std::span<const double> healthy, double false_alarm) {
  if (healthy.size() < kLeastHealthyRecords) return std::nullopt;
  const auto n = static_cast<double>(healthy.size());
  double mean = 0.0;
  for (const double value : healthy) {
    if (!(value > 0.0) || !std::isfinite(value)) return std::nullopt;
    mean += std::log(value) / n;
  }
  double squares = 0.0;
  for (const double value : healthy) {
    const double away = std::log(value) - mean;
    squares += away * away;
  }
  const double sd = std::sqrt(squares / (n - 1.0));
  const double quantile = metrics::student_t_quantile(1.0 - false_alarm, n - 1.0);
  return std::exp(mean + quantile * sd * std::sqrt(1.0 + 1.0 / n));
}

double threshold_with(double own, std::span<const CausePart> causes, double false_alarm) {
  double sum = 0.0;
  double squares = 0.0;
  double of_estimates = 0.0;
  for (const CausePart& each : causes) {
    sum += each.square;
    squares += each.square * each.square;
    of_estimates += each.square * each.square / each.freedom;
  }
  if (!(sum > 0.0)) return own;
  const double quantile =
      metrics::fisher_f_upper_quantile(false_alarm, sum * sum / squares, sum * sum / of_estimates);
  return std::sqrt(own * own + sum * quantile);
}

std::vector<double> moving_rms(std::span<const double> x, std::size_t window) {
  std::vector<double> result(x.size(), std::numeric_limits<double>::quiet_NaN());
  double sum = 0.0;
  std::size_t run = 0;  // number of consecutive samples that are not NaN
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::isnan(x[i])) {
      run = 0;
      sum = 0.0;
      continue;
    }
    sum += x[i] * x[i];
    ++run;
    if (run > window) sum -= x[i - window] * x[i - window];
    // Rounding errors accumulate in the sum, which could become negative.
    result[i] = std::sqrt(std::max(0.0, sum) / static_cast<double>(window));
  }
  return result;
}

}  // namespace rigcal::diagnosis
