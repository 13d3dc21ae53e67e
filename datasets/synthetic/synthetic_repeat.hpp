#pragma once

#include <cstdint>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Disturbances of one repeat of a synthetic condition, apart from the noise of its channels.
struct RepeatFate {
  double late_s = 0.0;            ///< delay of the start of the run after the start of the record
  double ripple_phase_rad = 0.0;  ///< phase of the supply pressure at time 0
  Overrides varied;               ///< values that only this repeat has
};

struct SyntheticRepeat {
  RepeatFate fate;
  Repeat record;  ///< SI, as delivered by sensors and converters
};

/// Returns the campaign with its values replaced by the true ones from [synthetic]. True values for
/// the rig replace start values, and true values for a leak level replace the values of that level.
/// Values set for a condition are kept. A missing duration or sample rate is taken from
/// [synthetic].
Campaign true_campaign(const Campaign& campaign);

/// Returns the channels that can be synthesised: all declared ones, except a reference that no
/// controller follows.
std::vector<Channel> made_channels(const Campaign& campaign);

/// Simulates repeats 1..n of a condition with a tolerance of 1e-8. If the repeats differ only in
/// noise, the condition is simulated once. Before a late run starts, the drive is zero, and the rig
/// has the state of the first instant of the run. The temperature is that of the condition, or
/// 293.15 K if it has none.
///
/// @param truth  true_campaign() of a campaign with synthetic settings
/// @param record  provides the drive if the waveform is recorded; may be null otherwise
/// @throws InputError  if there are no sample times, or if settings contradict the condition
/// @throws NoResultError  if a run could not be simulated
std::vector<SyntheticRepeat> synthetic_repeats(const Campaign& truth, const Condition& condition,
                                               const Record* record, std::uint64_t seed);

}  // namespace rigcal::datasets
