#pragma once

#include <optional>
#include <span>
#include <string>

#include "datasets/campaign/campaign.hpp"

namespace rigcal::datasets {

/// Apparent waveform of a recorded signal.
struct WaveformGuess {
  Waveform waveform = Waveform::recorded;
  std::optional<double> frequency_hz;  ///< for a sine, square or chirp
  std::optional<double> amplitude;     ///< half of peak to peak, in the unit of the signal
  std::optional<double> end_frequency_hz;
  /// Whether rigcal generates the same signal: without offset, and with the phase 0 at t = 0.
  bool can_be_generated = false;
  std::string description;  ///< in words: "a sine of 0.1 Hz", "3 steps", "constant"
};

/// Recognises a sine, a square wave, a chirp and steps.
///
/// A period goes from one upward crossing of the middle of the range to the next, with a hysteresis
/// of a fifth of the amplitude. Two or more periods that agree within 3 % make a sine, if a sine of
/// that frequency leaves less than 2 % of the variance, or a square wave, if nine of ten samples
/// are within a tenth of the amplitude of its two levels. Three or more periods that grow or shrink
/// by 30 %, all in one direction, make a chirp.
///
/// @param time_s  shape (n), increasing
/// @param signal  shape (n), any unit
WaveformGuess guess_waveform(std::span<const double> time_s, std::span<const double> signal);

}  // namespace rigcal::datasets
