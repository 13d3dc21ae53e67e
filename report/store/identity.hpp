#pragma once

#include "datasets/campaign/campaign.hpp"
#include "report/store/json.hpp"

namespace rigcal::report {

/// `report` of a result: what [report] of the campaign states about the test, and between which
/// dates its records were taken; null where nothing is known.
Json identity_json(const datasets::Campaign& campaign);

}  // namespace rigcal::report
