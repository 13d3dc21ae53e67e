#include "datasets/campaign/waveform.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>

namespace rigcal::datasets {
namespace {

/// In the order of Waveform.
constexpr std::array kWaveforms{
    WaveformSpec{Waveform::sine, "sine", &model::Signal::sine},
    WaveformSpec{Waveform::square, "square", &model::Signal::square, 2},
    WaveformSpec{Waveform::chirp, "chirp"},
    WaveformSpec{Waveform::recorded, "recorded"},
};

constexpr bool in_order() {
  for (std::size_t i = 0; i < kWaveforms.size(); ++i) {
    if (static_cast<std::size_t>(kWaveforms[i].waveform) != i) return false;
  }
  return true;
}
static_assert(in_order());

}  // namespace

const WaveformSpec& info(Waveform waveform) {
  return kWaveforms.at(static_cast<std::size_t>(waveform));
}

std::string_view to_string(Waveform waveform) { return info(waveform).name; }

bool is_periodic(Waveform waveform) { return info(waveform).periodic != nullptr; }

model::Signal periodic_signal(Waveform waveform, double amplitude, double frequency_hz) {
  if (!is_periodic(waveform)) throw std::invalid_argument("periodic_signal: not periodic");
  return info(waveform).periodic(amplitude, frequency_hz);
}

std::vector<std::pair<std::string, Waveform>> waveforms() {
  std::vector<std::pair<std::string, Waveform>> all;
  for (const WaveformSpec& row : kWaveforms) all.emplace_back(row.name, row.waveform);
  return all;
}

std::vector<std::pair<std::string, Waveform>> periodic_waveforms() {
  auto all = waveforms();
  std::erase_if(all, [](const auto& each) { return !is_periodic(each.second); });
  return all;
}

}  // namespace rigcal::datasets
