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
/// The offset of each repeat is found against the repeat that is nearest to all others, in the
/// channel that tells it best: the recorded reference, then the command, the position, the
/// pressures; one that jumps within a sample tells it only to a sample and gives way to the next.
///
/// Offsets are relative to their mean. How late all of them are together cannot be told from the
/// repeats; with the mean, an aligned average is as late against a generated reference as the plain
/// average, so that aligning neither invents nor removes a delay. With three or more repeats, those
/// whose offset lies out of all proportion (ten times the median distance from the median, and more
/// than a sample) are left out of that mean: one false start must not shift the others.
///
/// Offsets are reported always, but corrected only where one of them exceeds 0.02 samples and three
/// times its own standard deviation, because interpolation is not free; then all are that exceed
/// 0.02 samples, because to correct some of them would shift the mean.
///
/// @throws std::invalid_argument  no repeat, an empty or ragged one, or incompatible sampling: the
///                                message names the file and both rates or spans
AlignedRepeats align(const std::vector<Repeat>& repeats, bool correlate);

}  // namespace rigcal::datasets
