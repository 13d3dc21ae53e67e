#pragma once

#include <string>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Proposes `before = "rest"`, in words, where a record begins at the step of its drive: the first
/// value of a recorded drive is off its neutral (no command, or a reference where the piston is) by
/// a tenth of its range or more, it stays there for some samples, and the piston has yet to get
/// going. Held before the first sample such a drive leaves a delay and a lag of the valve nothing
/// to act on. Empty where none of it is so, or the campaign states what was before.
std::string drive_start_proposal(const Campaign& campaign, const Condition& condition,
                                 const Record& record);

}  // namespace rigcal::datasets
