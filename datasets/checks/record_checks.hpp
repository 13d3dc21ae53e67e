#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

// Doubts about a record that follow from what its campaign states.

namespace rigcal::datasets {

/// Returns the drive of the rig, generated or recorded, at each sample of a record.
/// @throws InputError  if the drive is a recorded one that the record lacks
std::vector<double> drive_at_samples(const Campaign& campaign, const Condition& condition,
                                     const Record& record);

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

/// Returns a warning if a condition states a generated drive and its record shows another one: the
/// rms deviation of the two exceeds 2 % of the larger rms, within the windows
/// of the record. Deviations that a shift by one sample explains do not count. Empty if both agree,
/// or if the drive was not recorded.
std::string stated_drive_warning(const Campaign& campaign, const Condition& condition,
                                 const Record& record);

/// Returns a warning if the motion is against its drive, as with a sensor of the wrong sign. In a
/// closed loop the motion follows its reference with a slope below -0.5 and a correlation below
/// -0.7. In an open loop the distance travelled in each tenth of a second (or longer, at most 200
/// in a record) has such a correlation with the mean drive, and no lag up to 0.3 s gives one above
/// 0.7. Empty otherwise.
std::string mirrored_motion_warning(const Campaign& campaign, const Condition& condition,
                                    const Record& record);

}  // namespace rigcal::datasets
