#pragma once

#include <span>
#include <vector>

#include "datasets/prepare/equal_runs.hpp"

namespace rigcal::datasets {

/// End of its range that a signal does not leave.
enum class RangeEnd { lowest, highest };

/// Runs of three or more exactly equal samples at the lowest or the highest value of a signal that
/// only a clipped sensor, amplifier or converter has; eight or more samples in all.
///
/// - They are where the signal falls off that value, by three steps of its resolution, and returns
///   within three samples, ten times and more: its noise is cut away on one side.
/// - Else what drives the rig must move in the run by 0.5 % of its range (a signal rests where
///   its drive does; the noise of a recorded drive is less), but not to its other end and back,
///   under which a sensor that is only clipped comes away (frozen_sensor.hpp). Where the signal
///   shows noise, an extreme value comes once or twice by chance, and that is enough. Where it does
///   not, because the converter is coarse or the signal simulated, the run must begin and end in
///   the middle of a motion: within three samples the signal moves by half its typical step, and by
///   two steps of its resolution more than the flat top of a parabola that the resolution hides.
///
/// @param x      shape (n), evenly sampled, finite
/// @param drive  shape (n): reference or command
/// @return       in order; empty for a constant signal
std::vector<EqualRun> clipped_runs(std::span<const double> x, std::span<const double> drive,
                                   RangeEnd end);

}  // namespace rigcal::datasets
