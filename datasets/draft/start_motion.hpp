#pragma once

#include <optional>
#include <span>

namespace rigcal::datasets {

/// Returns the motion of a signal within its first `window_s`: the difference between the means of
/// the first and the last quarter of the window. If there is such a motion, the mean over the
/// window differs from the start value. Returns std::nullopt if the motion is below 1 % of the
/// range of the whole signal or within four standard errors (for white noise, estimated from the
/// differences between neighbours), or if the window has fewer than eight samples.
///
/// @param time_s  shape (n), increasing
/// @param signal  shape (n), any unit
std::optional<double> motion_at_start(std::span<const double> time_s,
                                      std::span<const double> signal, double window_s);

}  // namespace rigcal::datasets
