#pragma once

#include <string>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Proposes `before = "rest"`, in words, if a record begins at the step of its drive. A proposal is
/// made if the first value of a recorded drive differs from neutral (zero command, or a reference
/// equal to the piston's position) by at least a tenth of the drive's range, and remains for some
/// samples while the piston is only beginning to move. If the drive were assumed to have had that
/// value before the first sample, a delay or lag of the valve would have no effect. Empty in all
/// other cases, and if the campaign states `before`.
std::string drive_start_proposal(const Campaign& campaign, const Condition& condition,
                                 const Record& record);

}  // namespace rigcal::datasets
