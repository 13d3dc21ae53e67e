#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/signal/signal.hpp"

namespace rigcal::datasets {

/// Index into the table of waveforms, for waveforms that the code refers to by name.
enum class Waveform { sine, square, chirp, recorded };

/// Describes one waveform. This row is the only place that decides whether plots show a period,
/// whether periods are averaged, whether the periodic state is solved for, and whether there is a
/// leak table.
struct WaveformSpec {
  std::string_view name;  ///< name in campaign files and results
  /// Makes a signal from amplitude and frequency [Hz]. Null if these do not describe the waveform
  /// completely; otherwise the waveform is periodic.
  model::Signal (*periodic)(double amplitude, double frequency_hz) = nullptr;
  int pieces = 1;  ///< number of equal pieces per period that begin with a jump; 1: no jumps
};
const WaveformSpec& info(Waveform waveform);

std::string_view to_string(Waveform waveform);
bool is_periodic(Waveform waveform);

/// Makes a periodic signal.
///
/// @param frequency_hz  frequency [Hz]
/// @throws std::invalid_argument  if the waveform is not periodic
model::Signal periodic_signal(Waveform waveform, double amplitude, double frequency_hz);

/// Names and values of the waveforms, in the order of the table.
std::vector<std::pair<std::string, Waveform>> waveforms();
std::vector<std::pair<std::string, Waveform>> periodic_waveforms();

}  // namespace rigcal::datasets
