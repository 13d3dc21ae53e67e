#pragma once

#include <optional>
#include <span>

namespace rigcal::datasets {

/// Motion of a signal within the first `window_s`, which makes its mean there differ from its
/// start: the difference between the means of the first and the last quarter of the window. Empty
/// if it is below 1 % of the range of the whole signal or within four standard errors (for white
/// noise, estimated from the differences between neighbours), or if the window has fewer than eight
/// samples.
///
/// @param time_s  shape (n), increasing
/// @param signal  shape (n), any unit
std::optional<double> motion_at_start(std::span<const double> time_s,
                                      std::span<const double> signal, double window_s);

}  // namespace rigcal::datasets
