#pragma once

#include <string>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Proposes `before = "rest"`, in words, if a record begins at the step of its drive. That is so if
/// the first value of a recorded drive differs from neutral (no command, or a reference at the
/// piston's position) by at least a tenth of its range, lasts for some samples, and the piston is
/// only beginning to move. With that value before the first sample a delay or lag of the valve
/// would have no effect. Empty in all other cases, and if the campaign states `before`.
std::string drive_start_proposal(const Campaign& campaign, const Condition& condition,
                                 const Record& record);

}  // namespace rigcal::datasets
