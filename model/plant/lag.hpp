#pragma once

#include <algorithm>

#include "model/arithmetic/dual.hpp"

namespace rigcal::model {

/// Shortest lag that the states of a rig resolve. No recorder separates it from none: its corner
/// is at 160 kHz. A shorter one would only cost steps after each jump of the drive.
inline constexpr double kLeastLag_s = 1e-6;

/// Replaces a shorter lag by the shortest resolved one. The derivative with respect to the lag
/// stays, so that a search that is at zero knows what a lag would change.
template <typename T>
T resolved_lag(const T& lag_s) {
  return lag_s + std::max(0.0, kLeastLag_s - value_of(lag_s));
}

}  // namespace rigcal::model
