#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace rigcal::model {

/// Largest difference [s] between two times that count as the same instant, because sample times
/// and edges are rounded. It is at most a nanosecond, unless the time stamps themselves are
/// coarser.
inline double same_instant_s(std::span<const double> times_s) {
  const double longest = std::max({1.0, std::abs(times_s.front()), std::abs(times_s.back())});
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  return std::max(std::min(1e-12 * longest, 1e-9), 8.0 * kEpsilon * longest);
}

}  // namespace rigcal::model
