#include "datasets/campaign/waveform.hpp"

#include <array>
#include <cstddef>
#include <stdexcept>

namespace rigcal::datasets {
namespace {

/// Table of waveforms, in the order of the enumeration. New rows are added at the end.
constexpr std::array kWaveforms{
    WaveformSpec{"sine", &model::Signal::sine},
    WaveformSpec{"square", &model::Signal::square, 2},
    WaveformSpec{"chirp"},
    WaveformSpec{"recorded"},
};

constexpr std::string_view name_of(Waveform waveform) {
  return kWaveforms.at(static_cast<std::size_t>(waveform)).name;
}
static_assert(name_of(Waveform::sine) == "sine" && name_of(Waveform::square) == "square" &&
              name_of(Waveform::chirp) == "chirp" && name_of(Waveform::recorded) == "recorded");

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
  for (std::size_t i = 0; i < kWaveforms.size(); ++i)
    all.emplace_back(kWaveforms[i].name, static_cast<Waveform>(i));
  return all;
}

std::vector<std::pair<std::string, Waveform>> periodic_waveforms() {
  auto all = waveforms();
  std::erase_if(all, [](const auto& each) { return !is_periodic(each.second); });
  return all;
}

}  // namespace rigcal::datasets
