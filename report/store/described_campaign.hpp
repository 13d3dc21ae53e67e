#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/campaign/diagnosis_settings.hpp"
#include "report/json/described.hpp"

// Names of campaign enumerations in result files.

namespace rigcal::report {

template <>
struct KeysOf<datasets::Channel> {
  static std::string_view text(datasets::Channel channel) { return info(channel).key; }
  static std::optional<datasets::Channel> from_text(const std::string& text) {
    return datasets::channel_from_key(text);
  }
};
template <>
inline std::vector<datasets::Waveform> every() {
  std::vector<datasets::Waveform> all;
  for (const auto& [name, waveform] : datasets::waveforms()) all.push_back(waveform);
  return all;
}

}  // namespace rigcal::report
