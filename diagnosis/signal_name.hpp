#pragma once

#include <string>

#include "datasets/campaign/campaign.hpp"

namespace rigcal::diagnosis {

/// Drive of a condition, by which records are comparable: "sine 0.1 Hz, 50.8 mm".
std::string signal_name(const datasets::Campaign& campaign, const datasets::Condition& condition);

}  // namespace rigcal::diagnosis
