#pragma once

#include <string>

#include "datasets/campaign/campaign.hpp"

namespace rigcal::report {

/// Returns the condition named by --condition.
///
/// @throws UsageError  if no condition has this id
const datasets::Condition& chosen_condition(const datasets::Campaign& campaign,
                                            const std::string& id);

}  // namespace rigcal::report
