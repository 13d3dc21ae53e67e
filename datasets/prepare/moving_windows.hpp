#pragma once

#include <span>
#include <vector>

#include "datasets/record.hpp"

namespace rigcal::datasets {

/// A stretch in which the piston moves, from a command step until it stops.
struct Motion {
  TimeWindow window;     ///< first sample of the new command to the first at which the piston stops
  double from_m = 0.0;   ///< position at the step
  double to_m = 0.0;     ///< position at the end of the constant command
  bool arrived = false;  ///< false: still moving when the command changes or the record ends
  double margin_m = 0.0;  ///< distance from `to_m` within which the piston has arrived
};

/// Finds the motions in a record from its samples.
///
/// A command is constant while it differs from its first sample by no more than 2 % of its range or
/// six standard deviations of its noise, whichever is larger. A step goes from one such level to
/// another, by more than 5 % of the range, in less than a tenth of the time for which the new level
/// lasts. A sine or a ramp has no steps. The first level counts, too, if the piston moves in it.
///
/// Under a constant command, the piston moves if its end is farther from its start than 5 % of the
/// record's range of positions and six standard deviations of the noise. It has arrived when its
/// distance from the end first falls below 1 % of the travel or twice the standard deviation over
/// the repeats, whichever is larger: while only some repeats have arrived, their mean does not
/// describe a motion. Positions are running medians, so that noise and spikes shift an arrival by a
/// few samples at most.
///
/// @param time_s      shape (n), increasing
/// @param command     shape (n), valve command or reference with steps, any unit
/// @param position_m  shape (n)
/// @param spread_m    shape (n), standard deviation over the repeats at each sample, NaN if
///                    unknown; or empty
/// @return            in order, not overlapping; empty if there is no step or no motion
/// @throws std::invalid_argument  if the sizes differ
std::vector<Motion> find_motions(std::span<const double> time_s, std::span<const double> command,
                                 std::span<const double> position_m,
                                 std::span<const double> spread_m);

}  // namespace rigcal::datasets
