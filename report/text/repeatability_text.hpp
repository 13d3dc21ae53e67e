#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "report/text/terminal.hpp"

namespace rigcal::report {

/// How well the repeats of each condition agree: their standard deviation, the noise floor that it
/// leaves to any model, how far the repeats lie apart in time; then notes and warnings.
std::string repeatability_text(const datasets::Campaign& campaign,
                               const std::vector<datasets::Record>& records, const Style& style);

}  // namespace rigcal::report
