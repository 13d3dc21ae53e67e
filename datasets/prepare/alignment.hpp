#pragma once

#include <string>
#include <vector>

#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Relative timing of the repeats of one condition.
struct AlignedRepeats {
  std::vector<double> offset_s;   ///< delay of each repeat relative to the others
  std::vector<double> shifted_s;  ///< offset_s if it is corrected, else 0
  /// Position of the common time base in each repeat: sample i is at i + shift, fractional.
  std::vector<double> shift;
  std::vector<std::string> warnings;
};

/// Puts repeats on the time base of the first one, using their time columns and, with `correlate`,
/// the offsets of their starts.
///
/// The offset of each repeat is found relative to the repeat closest to all others, in the best
/// channel available: the recorded reference, then the command, the position, the pressures. A
/// channel that jumps within a sample gives the offset only to within a sample, so the next one is
/// used.
///
/// Offsets are relative to their mean, since the repeats cannot reveal a delay that is common to
/// all of them. An aligned average therefore has the same delay relative to a generated reference
/// as the plain average: alignment neither adds nor removes a delay. With three or more repeats,
/// extreme offsets (more than ten times the median distance from the median, and more than a
/// sample) are excluded from that mean, so that one false start does not shift the others.
///
/// Offsets are always reported. Because interpolation has a cost, they are corrected only if one of
/// them exceeds 0.02 samples and three times its own standard deviation. All offsets above 0.02
/// samples are then corrected, because correcting only some would shift the mean.
///
/// @throws std::invalid_argument  if there is no repeat, if one is empty or ragged, or if their
///                         sampling is incompatible; the message names the file and both rates or
///                         spans
AlignedRepeats align(const std::vector<Repeat>& repeats, bool correlate);

}  // namespace rigcal::datasets
