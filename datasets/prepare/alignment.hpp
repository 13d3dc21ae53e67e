#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Relative timing of the repeats of one condition.
struct AlignedRepeats {
  std::vector<double> offset_s;   ///< delay of each repeat against the others
  std::vector<double> shifted_s;  ///< the same where it is corrected, else 0
  /// Position of the common time base in each repeat: sample i is at i + shift, fractional.
  std::vector<double> shift;
  std::vector<std::string> warnings;
};

/// Puts repeats on the time base of the first, by their time columns and, with `correlate`, by the
/// offsets of their starts.
///
/// The offset of each repeat is found against the repeat that is closest to all others. The best
/// channel is used: the recorded reference, then the command, the position, the pressures. A
/// channel that jumps within a sample gives the offset only to a sample, so the next one is used.
///
/// Offsets are relative to their mean, since the repeats do not show the delay of all of them
/// together. An aligned average thus has the same delay against a generated reference as the plain
/// average: aligning neither adds nor removes a delay. With three or more repeats, offsets out of
/// all proportion (ten times the median distance from the median, and more than a sample) are
/// excluded from that mean: one false start must not shift the others.
///
/// Offsets are always reported. They are corrected only if one of them exceeds 0.02 samples and
/// three times its own standard deviation, because interpolation has a cost. Then all offsets above
/// 0.02 samples are corrected, because correcting only some would shift the mean.
///
/// @throws std::invalid_argument  no repeat, an empty or ragged one, or incompatible sampling: the
///                                message names the file and both rates or spans
AlignedRepeats align(const std::vector<Repeat>& repeats, bool correlate);

}  // namespace rigcal::datasets
