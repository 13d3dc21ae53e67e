#include "datasets/draft/start_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rigcal::datasets {
namespace {

constexpr std::size_t kLeastSamples = 8;
constexpr double kLeastShare = 0.01;
constexpr double kErrors = 4.0;

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

std::optional<double> motion_at_start(std::span<const double> time_s,
                                      std::span<const double> signal, double window_s) {
  std::size_t count = 0;
  while (count < signal.size() && time_s[count] - time_s.front() <= window_s) ++count;
  if (count < kLeastSamples) return std::nullopt;
  const std::size_t quarter = count / 4;
  const double moved =
      mean_of(signal.subspan(count - quarter, quarter)) - mean_of(signal.first(quarter));
  double squares = 0.0;
  for (std::size_t i = 1; i < count; ++i)
    squares += (signal[i] - signal[i - 1]) * (signal[i] - signal[i - 1]);
  const double variance = 0.5 * squares / static_cast<double>(count - 1);
  const double error = std::sqrt(2.0 * variance / static_cast<double>(quarter));
  const auto [low, high] = std::minmax_element(signal.begin(), signal.end());
  if (std::abs(moved) < std::max(kLeastShare * (*high - *low), kErrors * error))
    return std::nullopt;
  return std::abs(moved);
}

}  // namespace rigcal::datasets
