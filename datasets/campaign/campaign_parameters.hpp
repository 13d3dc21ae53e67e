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
  rig,         ///< [rig.parameters]: everything but the controller's
  controller,  ///< [rig.controller]
  any,         ///< [synthetic] parameters
};

/// Declares a parameter to differ at random from repeat to repeat about its value
/// (ParameterSetting::between_repeats). Bounds that are NaN become eight standard deviations,
/// within the parameter's limits.
void differ_between_repeats(const model::ParameterSpec& spec, double sd, ParameterSetting& setting);

const model::ParameterSpec& spec_of(model::PlantKind plant, int index);

/// Keys of a group in the order of the parameter table.
std::vector<std::string> parameter_keys(model::PlantKind plant, ParameterGroup group);

/// Rows of the parameters of all plants: what one of them has is a key.
///
/// @param fitted  an entry may be a table with start, bounds and prior; else it is a known value
std::vector<CampaignKey> parameter_rows(ParameterGroup group, bool fitted);

/// A table of known values, as `parameters` of a condition.
inline KeyForm known_values_form(ParameterGroup group) {
  KeyForm form = table_form(parameter_rows(group, false));
  form.name = "table of known values";
  return form;
}

/// Explains why a value is outside the limits of the parameter table; empty if it is inside.
std::optional<std::string> outside_limits(const model::ParameterSpec& spec, double value);

/// Fills in missing bounds (NaN): value/10 to 10 value within the parameter's limits, or the limits
/// themselves for a value of 0.
///
/// @return  the problem if a bound is then not finite or the value is outside; else empty
std::optional<std::string> complete_bounds(const model::ParameterSpec& spec,
                                           ParameterSetting& setting);

/// Why a parameter cannot be fitted; empty if it can.
std::optional<std::string> cannot_be_fitted(const model::ParameterSpec& spec);

/// Table [rig.parameters] or [rig.controller]; keys in `others` belong to someone else.
///
/// @throws InputError
std::vector<ParameterSetting> read_settings(const TomlNode& table, model::PlantKind plant,
                                            ParameterGroup group,
                                            const std::vector<std::string>& others = {});

/// Table of known values: `parameters = { }` or `controller = { }`.
///
/// @throws InputError
Overrides read_overrides(const TomlNode& table, model::PlantKind plant, ParameterGroup group);

/// Whether a table of known values has one for the parameter of this table index.
bool has_entry(const Overrides& overrides, int index);

/// Parameters that contradict or miss one another.
struct ParameterConflict {
  std::string key;
  std::string message;
};
std::optional<ParameterConflict> find_conflict(const model::Rig& rig,
                                               const model::ParameterValues& values);

/// Conflict between the `gain_sd` of a channel and the gain of its sensor in [rig.parameters],
/// which is estimated or has a prior: the same uncertainty would count twice.
struct GainKnownTwice {
  Location where;  ///< place of the channel's `gain_sd`
  std::string message;
};
std::optional<GainKnownTwice> gain_known_twice(const Campaign& campaign);

}  // namespace rigcal::datasets
