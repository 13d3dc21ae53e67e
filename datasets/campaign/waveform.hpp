#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/signal/signal.hpp"

namespace rigcal::datasets {

/// Index in the table of waveforms, for those that code refers to by name.
enum class Waveform { sine, square, chirp, recorded };

/// Everything that the program knows about one waveform. This row alone decides whether it is drawn
/// by period, averaged over periods, solved for its periodic state and given a leak table.
struct WaveformSpec {
  std::string_view name;  ///< name in campaign files and results
  /// A signal of this amplitude and frequency [Hz]; null unless that is all that describes it, in
  /// which case it is periodic.
  model::Signal (*periodic)(double amplitude, double frequency_hz) = nullptr;
  int pieces = 1;  ///< equal pieces of a period that begin with a jump; 1: it has no jump
};
const WaveformSpec& info(Waveform waveform);

std::string_view to_string(Waveform waveform);
bool is_periodic(Waveform waveform);

/// @throws std::invalid_argument  the waveform is not periodic
model::Signal periodic_signal(Waveform waveform, double amplitude, double frequency_hz);

/// Names and values, in the order of the table.
std::vector<std::pair<std::string, Waveform>> waveforms();
std::vector<std::pair<std::string, Waveform>> periodic_waveforms();

}  // namespace rigcal::datasets
