#pragma once

#include <string>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// What tells, in words, that the piston of a record travels as far as its rig cannot: beyond the
/// known stroke of the cylinder by more than a tenth; without a stroke more than ten times as far
/// as the reference, or less than a five hundredth of it; without a reference more than 20 m. A
/// column in another unit than the campaign says looks so. Empty where nothing does.
std::string travel_warning(const Campaign& campaign, const Condition& condition,
                           const Record& record);

}  // namespace rigcal::datasets
