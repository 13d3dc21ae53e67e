#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "report/store/json.hpp"

namespace rigcal::app {

/// What is doubtful about the values of an earlier fit in this campaign, in words: a fit that was
/// stopped, and known values of the rig that were others when it was made.
std::vector<std::string> doubts_about(const report::EarlierFit& earlier,
                                      const datasets::Campaign& campaign);

}  // namespace rigcal::app
