#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "report/text/terminal.hpp"

namespace rigcal::report {

/// Agreement of the repeats of each condition: their standard deviation, the resulting noise floor
/// for any model, their relative delays; then notes and warnings.
std::string repeatability_text(const datasets::Campaign& campaign,
                               const std::vector<datasets::Record>& records, const Style& style);

}  // namespace rigcal::report
