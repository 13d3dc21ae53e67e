#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/synthetic/synthetic_repeat.hpp"

namespace rigcal::datasets {

/// Path of a repeat's file, relative to the campaign file.
///
/// @param repeat  from 1
std::string synthetic_record_path(const std::string& condition, int repeat);

/// Column of a channel in a synthetic record: the campaign's, or the channel's key where the
/// campaign names columns per repeat only.
std::string synthetic_column(const Campaign& campaign, Channel channel);

/// A record as CSV in the columns and units of the campaign, 10 significant digits, labelled as
/// synthetic in its first line.
/// @throws InputError  a column name that contains the separator
std::string synthetic_csv(const Campaign& campaign, const Repeat& repeat, std::uint64_t seed);

/// The campaign file for the synthetic records: `synthetic = true` in place of [synthetic], the
/// name with " (synthetic)", and `repeats` per condition.
std::string synthetic_campaign_text(const Campaign& campaign, std::uint64_t seed);

/// truth.json (schema "rigcal.truth/1"): every true value by name, scope and level, the settings of
/// the noise, and the disturbances of each repeat.
/// @param fates  per condition, per repeat
std::string truth_json(const Campaign& truth, std::uint64_t seed,
                       const std::vector<std::vector<RepeatFate>>& fates);

}  // namespace rigcal::datasets
