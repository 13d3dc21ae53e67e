#pragma once

#include <optional>
#include <vector>

namespace rigcal::datasets {

/// Interference of the mains in a channel's repeats.
struct MainsHum {
  double frequency_hz = 0.0;  ///< 50 or 60
  double amplitude = 0.0;     ///< in a single repeat, in the unit of the channel
};

/// The larger hum of 50 and of 60 Hz by which the repeats differ, if any. A trigger knows nothing
/// of the mains, so a hum has a phase of its own in each repeat and stays in the deviations from
/// their mean, where what the drive moves cancels.
///
/// It is found where a line within 0.5 Hz of the mains stands tenfold above every other frequency
/// up to 45 % away and makes up a fifth of the deviations' variance at least. Repeats that start at
/// different times differ at all harmonics of the drive, near the mains' too, and so have no such
/// line; nothing is judged where a harmonic falls there and its neighbours lie farther away.
///
/// @param deviations  of each repeat from the mean of all, shape (repeats, samples); a sample that
///                    a repeat lacks is NaN
/// @param rate_hz     of the samples; nothing is found below 2.9 times the mains' frequency, nor in
///                    records of less than about 0.3 s
/// @param drive_hz    frequency of a periodic drive, 0 if there is none
std::optional<MainsHum> mains_hum(const std::vector<std::vector<double>>& deviations,
                                  double rate_hz, double drive_hz);

}  // namespace rigcal::datasets
