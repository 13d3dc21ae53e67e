#pragma once

#include <string>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

// Doubts about a record that follow from what its campaign states.

namespace rigcal::datasets {

/// Returns a warning if the sample times of a record do not fit the signal that its condition
/// states. A generated drive needs at least four samples per period (for a chirp, at its highest
/// frequency). The record must last at least a hundredth of a period, and its length may differ
/// from the stated `duration` by a factor of 100 at most. A time column in ms that is read as s
/// breaks these rules. Empty if the times fit.
std::string drive_sampling_warning(const Condition& condition, const Record& record);

/// Proposes `before = "rest"`, in words, if a record begins at the step of its drive. A proposal is
/// made if the first value of a recorded drive differs from neutral (zero command, or a reference
/// equal to the piston's position) by at least a tenth of the drive's range, and remains for some
/// samples while the piston is only beginning to move. If the drive were assumed to have had that
/// value before the first sample, a delay or lag of the valve would have no effect. Empty in all
/// other cases, and if the campaign states `before`.
std::string drive_start_proposal(const Campaign& campaign, const Condition& condition,
                                 const Record& record);

/// Returns a warning if the piston travels farther in a record than its rig allows. If the stroke
/// is known, the limit is 1.1 times the stroke. Otherwise the travel must be between 1/500 of the
/// range of the reference and ten times that range or, without a reference, below 20 m. A column in
/// the wrong unit breaks these rules. Empty if the travel is plausible.
std::string travel_warning(const Campaign& campaign, const Condition& condition,
                           const Record& record);

}  // namespace rigcal::datasets
