#pragma once

#include "datasets/campaign/campaign.hpp"
#include "report/store/json.hpp"

namespace rigcal::report {

/// `report` of a result: the statements of the campaign's [report] about the test, and the first
/// and last date of its records; null if nothing is known.
Json identity_json(const datasets::Campaign& campaign);

}  // namespace rigcal::report
