#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace rigcal::model {

/// Sample times and edges are rounded: closer than this [s] is the same instant. A nanosecond at
/// most, unless the time stamps themselves are coarser.
inline double same_instant_s(std::span<const double> times_s) {
  const double longest = std::max({1.0, std::abs(times_s.front()), std::abs(times_s.back())});
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  return std::max(std::min(1e-12 * longest, 1e-9), 8.0 * kEpsilon * longest);
}

}  // namespace rigcal::model
