#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/campaign/keys/key_table.hpp"
#include "datasets/campaign/toml/toml_reader.hpp"

/// The sections of a campaign file: their keys and readers. Every reader throws InputError, naming
/// the key and its place.
namespace rigcal::datasets {

const KeyTable<Campaign>& recording_keys();
/// Reads [recording] into the campaign; needs the controller.
void read_recording(const TomlNode& node, Campaign& campaign);

/// Reads the limits from the `acceptance` table of a condition; needs the channels.
std::vector<AcceptanceLimit> read_limits(const TomlNode& node, const Campaign& campaign);

/// Reads `not_judged` from an `acceptance` section with these limits.
std::vector<Channel> read_not_judged(const TomlNode& node, const Campaign& campaign,
                                     const std::vector<AcceptanceLimit>& limits);

/// Reads [acceptance] into the campaign: limits and further requirements; needs rig and channels.
void read_acceptance(const TomlNode& node, Campaign& campaign);

/// Keys of [acceptance], and of `acceptance` in a condition.
std::vector<CampaignKey> acceptance_keys();
std::vector<CampaignKey> limit_keys();

/// The reader of [fit] needs the channels.
const KeyTable<FitSettings>& fit_keys();
FitSettings read_fit(const TomlNode& node, const Campaign& campaign);

KeyForm considered_form();
/// Reads [considered]; needs the rig.
StatedSizes read_considered(const TomlNode& node, const Campaign& campaign);

KeyForm between_days_form();
/// Reads [between_days]; needs the rig.
StatedSizes read_between_days(const TomlNode& node, const Campaign& campaign);

const KeyTable<DiagnosisSettings>& diagnosis_keys();
DiagnosisSettings read_diagnosis(const TomlNode& node);
/// Checks that `duty` names a condition in the campaign.
///
/// @throws InputError  if it does not
void check_duty(const TomlNode& node, const Campaign& campaign);

const std::vector<CampaignKey>& report_keys();
ReportSettings read_report(const TomlNode& node);
/// Copies the uncertainties stated for the sensors in [report] to the channels.
///
/// @param root  the whole file
/// @throws InputError  if two statements about one channel differ; names both places
void apply_sensors(const TomlNode& root, Campaign& campaign);

const KeyTable<DesignSettings>& design_keys();
/// Reads [design]; needs the rig, the channels and the conditions.
DesignSettings read_design(const TomlNode& node, const Campaign& campaign);

const KeyTable<SimulationSettings>& simulation_keys();
SimulationSettings read_simulation(const TomlNode& node);

const KeyTable<SyntheticSettings>& synthetic_keys();
SyntheticSettings read_synthetic(const TomlNode& node, model::PlantKind plant);

const KeyTable<Condition>& condition_keys();
/// Reads one [[condition]]; needs the rig and the channels.
Condition read_condition(const TomlNode& node, const Campaign& campaign);

/// Converts a table key to a channel. The error for an unknown key lists the known channels.
Channel read_channel_key(const TomlNode& table, const std::string& key);

/// Returns the keys of the channels that can be compared with a model.
std::vector<std::string> output_channel_names();

/// Describes a table of quantities by channel. Each value is in the unit of its channel.
KeyForm channels_form(std::string name);

/// Returns the output channels of the records, in the order of the channel table.
std::vector<Channel> output_channels(const Campaign& campaign);

/// Makes the checks that involve several sections: parameters without a value, contradictions,
/// conditions without records.
///
/// @param start  location for errors that concern the whole file
void check_campaign(const Campaign& campaign, const Location& start);

}  // namespace rigcal::datasets
