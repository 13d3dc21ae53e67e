#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

namespace rigcal::metrics {

/// Returns 100 |mean e| / (max y - min y), in percent: the constant error of the model, which noise
/// does not hide. The signals are those of metrics/agreement.hpp.
///
/// @throws std::domain_error  the measured signal is constant
inline double mean_error_percent(std::span<const double> measured,
                                 std::span<const double> simulated) {
  const auto [low, high] = std::minmax_element(measured.begin(), measured.end());
  if (!(*high > *low))
    throw std::domain_error("mean_error_percent: the measured signal is constant");
  double sum = 0.0;
  for (std::size_t i = 0; i < measured.size(); ++i) sum += measured[i] - simulated[i];
  return 100.0 * std::abs(sum) / static_cast<double>(measured.size()) / (*high - *low);
}

}  // namespace rigcal::metrics
