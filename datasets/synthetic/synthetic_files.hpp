#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/synthetic/synthetic_repeat.hpp"

namespace rigcal::datasets {

/// Returns the path of a repeat's file, relative to the campaign file.
///
/// @param repeat  from 1
std::string synthetic_record_path(const std::string& condition, int repeat);

/// Returns the column for a channel in a synthetic record: the one named in the campaign, or the
/// channel's key if the campaign names columns only per repeat.
std::string synthetic_column(const Campaign& campaign, Channel channel);

/// Returns a record as CSV, with the campaign's columns and units and 10 significant digits. The
/// first line labels it as synthetic.
/// @throws InputError  if a column name contains the separator
std::string synthetic_csv(const Campaign& campaign, const Repeat& repeat, std::uint64_t seed);

/// Returns the campaign file for the synthetic records, with `synthetic = true` instead of
/// [synthetic], " (synthetic)" added to the name, and `repeats` for each condition.
std::string synthetic_campaign_text(const Campaign& campaign, std::uint64_t seed);

/// Returns the text of truth.json (schema "rigcal.truth/1"): every true value by name, scope and
/// level, the noise settings, and the disturbances of each repeat.
/// @param fates  shape (conditions, repeats)
std::string truth_json(const Campaign& truth, std::uint64_t seed,
                       const std::vector<std::vector<RepeatFate>>& fates);

}  // namespace rigcal::datasets
