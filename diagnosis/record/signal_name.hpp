#pragma once

#include <string>

#include "datasets/campaign/campaign.hpp"

namespace rigcal::diagnosis {

/// Returns the name of a condition's drive: "sine 0.1 Hz, 50.8 mm". Records with the same name are
/// comparable.
std::string signal_name(const datasets::Campaign& campaign, const datasets::Condition& condition);

}  // namespace rigcal::diagnosis
