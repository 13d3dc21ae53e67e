#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Changes made to the repeats of a condition before averaging, and what was noticed about them.
struct Conditioning {
  double noise_gain = 1.0;  ///< factor by which decimation changes the sd of white noise
  std::vector<std::string> notes;
  std::vector<std::string> warnings;
};

/// Reports spikes in measured channels, replaces them if the campaign excludes them, and decimates
/// records that are sampled faster than `decimate_to`.
///
/// @throws std::invalid_argument  if a record cannot be decimated, or if the repeats need different
///                                factors
Conditioning condition_repeats(const Campaign& campaign, std::vector<Repeat>& repeats);

}  // namespace rigcal::datasets
