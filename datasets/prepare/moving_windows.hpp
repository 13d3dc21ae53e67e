#pragma once

#include <span>
#include <vector>

#include "datasets/record.hpp"

namespace rigcal::datasets {

/// A stretch in which the piston moves from where a command step found it to where it stops.
struct Motion {
  TimeWindow window;      ///< first sample of the new command to the first sample at the stop
  double from_m = 0.0;    ///< position at the step
  double to_m = 0.0;      ///< position at the end of the constant command
  bool arrived = false;   ///< false: still moving where the command changes or the record ends
  double margin_m = 0.0;  ///< distance from `to_m` that counts as arrived
};

/// Motions of a record, from its own samples.
///
/// A command is constant while it stays within 2 % of its range, or six standard deviations of its
/// noise, of its first sample. A step goes from one such level to another, by more than 5 % of the
/// range, in less than a tenth of the time for which the new level lasts. A sine or a ramp has no
/// steps. The first level counts, too, if the piston moves in it.
///
/// The piston moves under a constant command if its end is farther from its start than 5 % of the
/// record's range of positions and six standard deviations of the noise. It has arrived when it is
/// first closer to the end than 1 % of the travel or twice the standard deviation over the repeats,
/// whichever is larger: while only some repeats have arrived, their mean is no motion. Positions
/// are running medians, so that noise and spikes move an arrival by a few samples at most.
///
/// @param time_s      shape (n), increasing
/// @param command     shape (n), valve command or reference with steps, any unit
/// @param position_m  shape (n)
/// @param spread_m    shape (n), standard deviation over the repeats at each sample, NaN if
///                    unknown; or empty
/// @return            in order, not overlapping; empty if nothing steps or moves
/// @throws std::invalid_argument  sizes differ
std::vector<Motion> find_motions(std::span<const double> time_s, std::span<const double> command,
                                 std::span<const double> position_m,
                                 std::span<const double> spread_m);

}  // namespace rigcal::datasets
