#pragma once

#include <optional>
#include <span>

namespace rigcal::datasets {

/// How far a signal moves within the first `window_s`, so that its mean there is not where it
/// starts: the difference between the means of the first and the last quarter of the window. Empty
/// if that is below 1 % of the range of the whole signal, or within four standard errors (of
/// white noise, from the differences of neighbours), or the window holds fewer than eight samples.
///
/// @param time_s  shape (n), increasing
/// @param signal  shape (n), any unit
std::optional<double> motion_at_start(std::span<const double> time_s,
                                      std::span<const double> signal, double window_s);

}  // namespace rigcal::datasets
