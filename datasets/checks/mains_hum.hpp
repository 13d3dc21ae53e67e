#pragma once

#include <optional>
#include <vector>

namespace rigcal::datasets {

/// Mains interference in the repeats of a channel.
struct MainsHum {
  double frequency_hz = 0.0;  ///< 50 or 60
  double amplitude = 0.0;     ///< in a single repeat, in the unit of the channel
};

/// Finds mains hum, at 50 or 60 Hz, in the differences between repeats; the larger one if both are
/// present. A trigger is not synchronous with the mains, so hum has a different phase in each
/// repeat. It therefore remains in the deviations from the mean, in which the response to the drive
/// cancels.
///
/// Hum is a line within 0.5 Hz of the mains frequency. Its power must be ten times that of every
/// other frequency up to 45 % away, and it must make up at least a fifth of the deviations'
/// variance. Repeats that start at different times differ at all harmonics of the drive, including
/// those close to the mains frequency, and therefore have no such line. Nothing is reported if a
/// harmonic is at the mains frequency and the neighbouring harmonics are more than 45 % away.
///
/// @param deviations  deviations of each repeat from the mean of all, shape (repeats, samples); NaN
///                    where a repeat has no sample
/// @param rate_hz     sample rate; nothing is found below 2.9 times the mains frequency, or in
///                    records shorter than about 0.3 s
/// @param drive_hz    frequency of a periodic drive, 0 if there is none
std::optional<MainsHum> mains_hum(const std::vector<std::vector<double>>& deviations,
                                  double rate_hz, double drive_hz);

}  // namespace rigcal::datasets
