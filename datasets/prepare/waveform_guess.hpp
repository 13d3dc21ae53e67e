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
  std::optional<double> amplitude;     ///< half the peak-to-peak value, in the unit of the signal
  std::optional<double> end_frequency_hz;
  /// Whether rigcal can generate the same signal: it has no offset, and its phase is 0 at t = 0.
  bool can_be_generated = false;
  std::string description;  ///< in words: "a sine of 0.1 Hz", "3 steps", "constant"
};

/// Recognises a sine, a square wave, a chirp and steps.
///
/// A period is the time from one upward crossing of the middle of the range to the next, with a
/// hysteresis of a fifth of the amplitude. Two or more periods that agree within 3 % indicate a
/// sine if a sine of that frequency leaves less than 2 % of the variance, and a square wave if nine
/// out of ten samples are within a tenth of the amplitude of its two levels. Three or more periods
/// that increase or decrease by 30 %, all in one direction, indicate a chirp.
///
/// @param time_s  shape (n), increasing
/// @param signal  shape (n), any unit
WaveformGuess guess_waveform(std::span<const double> time_s, std::span<const double> signal);

}  // namespace rigcal::datasets
