#pragma once

#include <string>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Returns a warning if the piston travels farther in a record than its rig allows. If the stroke
/// is known, the limit is 1.1 times the stroke. Otherwise the travel must be between 1/500 of the
/// range of the reference and ten times that range or, without a reference, below 20 m. A column in
/// the wrong unit breaks these rules. Empty if the travel is plausible.
std::string travel_warning(const Campaign& campaign, const Condition& condition,
                           const Record& record);

}  // namespace rigcal::datasets
