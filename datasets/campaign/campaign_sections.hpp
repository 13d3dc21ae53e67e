#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/campaign/toml/toml_reader.hpp"

/// The sections of a campaign file, one reader each. All throw InputError with the key and its
/// place.
namespace rigcal::datasets {

/// [recording] into the campaign, whose controller is known already.
void read_recording(const TomlNode& node, Campaign& campaign);

/// The limits in an `acceptance` of a condition; needs the channels.
std::vector<AcceptanceLimit> read_limits(const TomlNode& node, const Campaign& campaign);

/// Reads the channels in `not_judged` of an `acceptance` section that has these limits.
std::vector<Channel> read_not_judged(const TomlNode& node, const Campaign& campaign,
                                     const std::vector<AcceptanceLimit>& limits);

/// Reads [acceptance] into the campaign: limits and further conditions; needs rig and channels.
void read_acceptance(const TomlNode& node, Campaign& campaign);

/// [fit]; needs the channels.
FitSettings read_fit(const TomlNode& node, const Campaign& campaign);

/// [considered]; needs the rig.
ConsideredSettings read_considered(const TomlNode& node, const Campaign& campaign);

/// [between_days]; needs the rig.
BetweenDaysSettings read_between_days(const TomlNode& node, const Campaign& campaign);

/// [diagnosis]
DiagnosisSettings read_diagnosis(const TomlNode& node);
/// @throws InputError  `duty` names no condition of the campaign
void check_duty(const TomlNode& node, const Campaign& campaign);

/// [report]
ReportSettings read_report(const TomlNode& node);
/// Copies the uncertainties that the sensors of [report] state into the channels.
///
/// @param root  the whole file
/// @throws InputError  two statements about one channel differ (names both places)
void apply_sensors(const TomlNode& root, Campaign& campaign);

/// [design]; needs the rig, the channels and the conditions.
DesignSettings read_design(const TomlNode& node, const Campaign& campaign);

/// [simulation]
SimulationSettings read_simulation(const TomlNode& node);

/// [synthetic]
SyntheticSettings read_synthetic(const TomlNode& node, model::PlantKind plant);

/// One [[condition]]; needs the rig and the channels.
Condition read_condition(const TomlNode& node, const Campaign& campaign);

/// Reads the name of a channel as a key of a table; an error names the known ones.
Channel read_channel_key(const TomlNode& table, const std::string& key);

/// Output channels of the records, in the order of the channel table.
std::vector<Channel> output_channels(const Campaign& campaign);

/// Checks that need several sections: parameters without a value, contradictions, runs without
/// records.
///
/// @param start  start of the file
void check_campaign(const Campaign& campaign, const Location& start);

}  // namespace rigcal::datasets
