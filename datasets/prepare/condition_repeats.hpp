#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// What was done to the repeats of a condition before averaging, and seen in them.
struct Conditioning {
  double noise_gain = 1.0;  ///< what decimation leaves of the standard deviation of white noise
  std::vector<std::string> notes;
  std::vector<std::string> warnings;
};

/// Names spikes of measured channels, replaces them if the campaign excludes them, and decimates
/// what is denser than `decimate_to`.
///
/// @throws std::invalid_argument  a record cannot be decimated, or the repeats by different factors
Conditioning condition_repeats(const Campaign& campaign, std::vector<Repeat>& repeats);

}  // namespace rigcal::datasets
