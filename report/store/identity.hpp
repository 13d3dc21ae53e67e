#pragma once

#include "datasets/campaign/campaign.hpp"
#include "report/store/json.hpp"

namespace rigcal::report {

/// Makes the `report` member of a result: what [report] in the campaign states about the test, and
/// the first and last date of the records; null if neither is given.
Json identity_json(const datasets::Campaign& campaign);

}  // namespace rigcal::report
