#pragma once

#include <span>
#include <vector>

#include "datasets/prepare/equal_runs.hpp"

namespace rigcal::datasets {

/// End of its range that a signal does not leave.
enum class RangeEnd { lowest, highest };

/// Finds runs of three or more exactly equal samples at the lowest or the highest value of a
/// signal, eight or more samples in all, that only a clipped sensor, amplifier or converter causes.
/// One of two conditions must be met:
///
/// - The signal leaves that value by three steps of its resolution and returns within three
///   samples, ten times or more: its noise is cut off on one side.
/// - The drive moves in the run by 0.5 % of its range (a signal is constant if its drive is; the
///   noise of a recorded drive is less), but not to its other end and back, which would release a
///   clipped sensor (frozen_sensor.hpp). That is enough if the signal shows noise, since an extreme
///   value then comes once or twice by chance. Without noise, because the converter is coarse or
///   the signal simulated, the run must also begin and end in the middle of a motion. Within three
///   samples the signal must move by half its typical step, and by two steps of its resolution more
///   than the flat top of a parabola that the resolution hides.
///
/// @param x      shape (n), evenly sampled, finite
/// @param drive  shape (n): reference or command
/// @return       in order; empty for a constant signal
std::vector<EqualRun> clipped_runs(std::span<const double> x, std::span<const double> drive,
                                   RangeEnd end);

}  // namespace rigcal::datasets
