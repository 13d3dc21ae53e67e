#pragma once

#include <string>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// What tells, in words, that the times of a record do not go with the signal that its condition
/// states: fewer than four samples a period of a generated drive (of a chirp: at its fastest), less
/// than a hundredth of a period in all, or a length that is off from the stated `duration` by a
/// factor of 100. A time column in ms that was read as s looks so. Empty where nothing does.
std::string drive_sampling_warning(const Condition& condition, const Record& record);

}  // namespace rigcal::datasets
