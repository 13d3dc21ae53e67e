#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Disturbances of one repeat of a synthetic condition, apart from the noise of its channels.
struct RepeatFate {
  double late_s = 0.0;            ///< delay of the run's start after that of the record
  double ripple_phase_rad = 0.0;  ///< phase of the supply pressure at time 0
  Overrides varied;               ///< values of this repeat alone
};

struct SyntheticRepeat {
  RepeatFate fate;
  Repeat record;  ///< SI, as the sensors and converters give it
};

/// The campaign with the true values of [synthetic] in place of its own: those of the rig replace
/// its starts, those of a leak level replace that level's. Values of a condition stay; a missing
/// duration or sample rate is taken from [synthetic].
Campaign true_campaign(const Campaign& campaign);

/// Channels that can be made: all declared ones but a reference that no controller follows.
std::vector<Channel> made_channels(const Campaign& campaign);

/// Repeats 1..n of a condition, simulated at a tolerance of 1e-8; a condition whose repeats differ
/// in noise alone is simulated once. Before a late run starts the rig is as at its first instant
/// and the drive is zero. Temperature is the condition's, 293.15 K where it has none.
///
/// @param truth   true_campaign() of a campaign with synthetic settings
/// @param record  of the drive where the waveform is recorded; may be null otherwise
/// @throws InputError     no sample times, or settings that contradict the condition
/// @throws NoResultError  a run could not be simulated
std::vector<SyntheticRepeat> synthetic_repeats(const Campaign& truth, const Condition& condition,
                                               const Record* record, std::uint64_t seed);

}  // namespace rigcal::datasets
