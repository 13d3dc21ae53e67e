#pragma once

#include <string>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Warns, in words, if the piston of a record travels farther than its rig allows. With a known
/// stroke the limit is 1.1 times the stroke. Without a stroke the travel must be between a five
/// hundredth of the reference's range and ten times that range; without a reference it must be
/// below 20 m. A column in a wrong unit breaks these rules. Empty if the travel is plausible.
std::string travel_warning(const Campaign& campaign, const Condition& condition,
                           const Record& record);

}  // namespace rigcal::datasets
