#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/campaign/keys/key_form.hpp"
#include "datasets/campaign/toml/toml_reader.hpp"

namespace rigcal::datasets {

/// Section of the campaign file that a parameter belongs to.
enum class ParameterGroup {
  rig,         ///< [rig.parameters]: all parameters except the controller's
  controller,  ///< [rig.controller]
  any,         ///< [synthetic] parameters
};

/// Declares that a parameter varies randomly between repeats about its value
/// (ParameterSetting::between_repeats). Bounds that are NaN are set to eight standard deviations
/// from the value, within the parameter's limits.
void differ_between_repeats(const model::ParameterSpec& spec, double sd, ParameterSetting& setting);

/// Lists the keys in a group, in the order of the parameter table.
std::vector<std::string> parameter_keys(model::PlantKind plant, ParameterGroup group);

/// Returns rows for the parameters of all plants. A parameter of any plant is an accepted key.
///
/// @param fitted  true: an entry may be a table with start, bounds and prior; false: it is a known
///                value
std::vector<CampaignKey> parameter_rows(ParameterGroup group, bool fitted);

/// Describes a table of known values, such as `parameters` in a condition.
inline KeyForm known_values_form(ParameterGroup group) {
  KeyForm form = table_form(parameter_rows(group, false));
  form.name = "table of known values";
  return form;
}

/// Explains why a value is outside the limits of the parameter table; empty if it is inside.
std::optional<std::string> outside_limits(const model::ParameterSpec& spec, double value);

/// Sets missing bounds (NaN) to value/10 and 10 value within the parameter's limits, or to the
/// limits themselves if the value is 0.
///
/// @return  the problem if a bound is still not finite or the value is outside the bounds,
///          otherwise std::nullopt
std::optional<std::string> complete_bounds(const model::ParameterSpec& spec,
                                           ParameterSetting& setting);

/// Explains why a parameter cannot be fitted; std::nullopt if it can.
std::optional<std::string> cannot_be_fitted(const model::ParameterSpec& spec);

/// Reads the table [rig.parameters] or [rig.controller]. Ignores the keys in `others`, which other
/// functions read.
///
/// @throws InputError  if a key or value is not allowed
std::vector<ParameterSetting> read_settings(const TomlNode& table, model::PlantKind plant,
                                            ParameterGroup group,
                                            const std::vector<std::string>& others = {});

/// Reads a table of known values: `parameters = { }` or `controller = { }`.
///
/// @throws InputError  if a key or value is not allowed
Overrides read_overrides(const TomlNode& table, model::PlantKind plant, ParameterGroup group);

/// Whether a list of known values has one for the parameter with this table index.
bool has_entry(const Overrides& overrides, int index);

/// A conflict between parameters: they contradict each other, or one requires another that is
/// missing.
struct ParameterConflict {
  std::string key;
  std::string message;
};
std::optional<ParameterConflict> find_conflict(const model::Rig& rig,
                                               const model::ParameterValues& values);

/// A conflict between the `gain_sd` of a channel and a sensor gain in [rig.parameters] that is
/// estimated or has a prior. The same uncertainty would be counted twice.
struct GainKnownTwice {
  Location where;  ///< place of the channel's `gain_sd`
  std::string message;
};
std::optional<GainKnownTwice> gain_known_twice(const Campaign& campaign);

}  // namespace rigcal::datasets
