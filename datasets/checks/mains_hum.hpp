#pragma once

#include <optional>
#include <vector>

namespace rigcal::datasets {

/// Interference of the mains in a channel's repeats.
struct MainsHum {
  double frequency_hz = 0.0;  ///< 50 or 60
  double amplitude = 0.0;     ///< in a single repeat, in the unit of the channel
};

/// Finds the larger hum of 50 and of 60 Hz by which the repeats differ, if any. A trigger is not
/// synchronous with the mains, so a hum has another phase in each repeat. It therefore stays in the
/// deviations from the mean, in which the response to the drive cancels.
///
/// A hum is a line within 0.5 Hz of the mains frequency that is ten times as large as every other
/// frequency up to 45 % away, and makes up at least a fifth of the deviations' variance. Repeats
/// that start at different times differ at all harmonics of the drive, also near the mains
/// frequency, and so have no such line. There is no verdict if a harmonic is there and its
/// neighbours are farther away.
///
/// @param deviations  of each repeat from the mean of all, shape (repeats, samples); NaN where a
///                    repeat has no sample
/// @param rate_hz     sample rate; nothing is found below 2.9 times the mains frequency, nor in
///                    records shorter than about 0.3 s
/// @param drive_hz    frequency of a periodic drive, 0 if there is none
std::optional<MainsHum> mains_hum(const std::vector<std::vector<double>>& deviations,
                                  double rate_hz, double drive_hz);

}  // namespace rigcal::datasets
