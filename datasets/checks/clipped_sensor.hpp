#pragma once

#include <span>
#include <vector>

#include "datasets/checks/equal_runs.hpp"

namespace rigcal::datasets {

/// The end of the range at which a signal is clipped.
enum class RangeEnd { lowest, highest };

/// Finds runs of at least three exactly equal samples, at the lowest or highest value of a signal,
/// that only a clipped sensor, amplifier or converter explains. The runs must have at least eight
/// samples in total. One of two conditions must be met:
///
/// - The signal leaves that value by three steps of its resolution and returns within three
///   samples, at least ten times: its noise is cut off on one side.
/// - The drive moves by at least 0.5 % of its range during the run. (If the drive is constant, so
///   is the signal, and the noise of a recorded drive is smaller.) The drive must not go to its
///   other end and back, which would release a clipped sensor (frozen_sensor.hpp). This is enough
///   if the signal shows noise, because an extreme value then occurs only once or twice by chance.
///   Without noise, because the converter is coarse or the signal is simulated, the run must also
///   begin and end in the middle of a motion. Within three samples, the signal must then move by at
///   least half its typical step, and by two steps of its resolution more than a parabola whose
///   flat top the resolution hides.
///
/// @param x      shape (n), evenly sampled, finite
/// @param drive  shape (n), reference or command
/// @return       in order; empty for a constant signal
std::vector<EqualRun> clipped_runs(std::span<const double> x, std::span<const double> drive,
                                   RangeEnd end);

}  // namespace rigcal::datasets
