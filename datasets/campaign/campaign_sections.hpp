#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/campaign/keys/key_table.hpp"
#include "datasets/campaign/toml/toml_reader.hpp"

/// The sections of a campaign file: the keys of each, and its reader. All readers throw InputError
/// with the key and its place.
namespace rigcal::datasets {

const KeyTable<Campaign>& recording_keys();
/// [recording] into the campaign, whose controller is known already.
void read_recording(const TomlNode& node, Campaign& campaign);

/// Reads the limits from the `acceptance` table of a condition; needs the channels.
std::vector<AcceptanceLimit> read_limits(const TomlNode& node, const Campaign& campaign);

/// Reads `not_judged` from an `acceptance` section with these limits.
std::vector<Channel> read_not_judged(const TomlNode& node, const Campaign& campaign,
                                     const std::vector<AcceptanceLimit>& limits);

/// Reads [acceptance] into the campaign: limits and further requirements; needs rig and channels.
void read_acceptance(const TomlNode& node, Campaign& campaign);

/// Keys of [acceptance], and those of `acceptance` in a condition.
std::vector<CampaignKey> acceptance_keys();
std::vector<CampaignKey> limit_keys();

/// [fit]; needs the channels.
const KeyTable<FitSettings>& fit_keys();
FitSettings read_fit(const TomlNode& node, const Campaign& campaign);

KeyForm considered_form();
/// [considered]; needs the rig.
ConsideredSettings read_considered(const TomlNode& node, const Campaign& campaign);

KeyForm between_days_form();
/// [between_days]; needs the rig.
BetweenDaysSettings read_between_days(const TomlNode& node, const Campaign& campaign);

/// [diagnosis]
const KeyTable<DiagnosisSettings>& diagnosis_keys();
DiagnosisSettings read_diagnosis(const TomlNode& node);
/// Checks that `duty` names a condition in the campaign.
///
/// @throws InputError  if it does not
void check_duty(const TomlNode& node, const Campaign& campaign);

/// [report]
const std::vector<CampaignKey>& report_keys();
ReportSettings read_report(const TomlNode& node);
/// Copies the uncertainties stated for the sensors in [report] to the channels.
///
/// @param root  the whole file
/// @throws InputError  if two statements about one channel differ; names both places
void apply_sensors(const TomlNode& root, Campaign& campaign);

const KeyTable<DesignSettings>& design_keys();
/// [design]; needs the rig, the channels and the conditions.
DesignSettings read_design(const TomlNode& node, const Campaign& campaign);

/// [simulation]
const KeyTable<SimulationSettings>& simulation_keys();
SimulationSettings read_simulation(const TomlNode& node);

/// [synthetic]
const KeyTable<SyntheticSettings>& synthetic_keys();
SyntheticSettings read_synthetic(const TomlNode& node, model::PlantKind plant);

const KeyTable<Condition>& condition_keys();
/// One [[condition]]; needs the rig and the channels.
Condition read_condition(const TomlNode& node, const Campaign& campaign);

/// Converts a table key to a channel; an error lists the known channels.
Channel read_channel_key(const TomlNode& table, const std::string& key);

/// Keys of the channels that a model may be compared with.
std::vector<std::string> output_channel_names();

/// A table of quantities by channel; its values are in the unit of the channel.
KeyForm channels_form(std::string name);

/// Output channels of the records, in the order of the channel table.
std::vector<Channel> output_channels(const Campaign& campaign);

/// Makes the checks that involve several sections: parameters without a value, contradictions,
/// conditions without records.
///
/// @param start  location for errors that concern the whole file
void check_campaign(const Campaign& campaign, const Location& start);

}  // namespace rigcal::datasets
