#pragma once

#include <string>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Returns a warning if the sample times of a record do not fit the signal that its condition
/// states. A generated drive needs at least four samples per period (for a chirp, at its highest
/// frequency). The record must last at least a hundredth of a period, and its length may differ
/// from the stated `duration` by a factor of 100 at most. A time column in ms that is read as s
/// breaks these rules. Empty if the times fit.
std::string drive_sampling_warning(const Condition& condition, const Record& record);

}  // namespace rigcal::datasets
