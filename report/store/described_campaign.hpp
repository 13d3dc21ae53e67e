#pragma once

#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "report/json/described.hpp"

// The enumerations of a campaign, as results name them.

namespace rigcal::report {

template <>
inline std::vector<datasets::Waveform> every() {
  std::vector<datasets::Waveform> all;
  for (const auto& [name, waveform] : datasets::waveforms()) all.push_back(waveform);
  return all;
}

}  // namespace rigcal::report
