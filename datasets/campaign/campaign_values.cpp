#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "common/suggest.hpp"
#include "datasets/campaign/campaign.hpp"
#include "datasets/campaign/campaign_parameters.hpp"

namespace rigcal::datasets {
namespace {

int index_of(const Campaign& campaign, std::string_view option, std::string_view name) {
  const int index = model::parameter_index(campaign.rig.plant, name);
  if (index < 0) {
    throw UsageError(
        fmt::format("{}: {}", option,
                    unknown_name_message("parameter", name,
                                         parameter_keys(campaign.rig.plant, ParameterGroup::any))));
  }
  if (model::parameter_spec(campaign.rig.plant, index).kind == model::ParameterKind::controller &&
      campaign.rig.controller == model::ControllerKind::none) {
    throw UsageError(
        fmt::format("{}: the rig of this campaign has no controller, so {} has no "
                    "effect",
                    option, name));
  }
  return index;
}

ParameterSetting& setting_or_new(Campaign& campaign, int index, double value) {
  for (ParameterSetting& setting : campaign.parameters) {
    if (setting.index == index) return setting;
  }
  ParameterSetting setting;
  setting.index = index;
  setting.value = value;
  setting.lower = std::numeric_limits<double>::quiet_NaN();
  setting.upper = std::numeric_limits<double>::quiet_NaN();
  setting.where = {campaign.file.string()};
  campaign.parameters.push_back(setting);
  return campaign.parameters.back();
}

const Overrides* level_overrides(const Campaign& campaign, const Condition& condition) {
  if (!condition.leak_level) return nullptr;
  const auto level = campaign.leak_levels.find(*condition.leak_level);
  return level == campaign.leak_levels.end() ? nullptr : &level->second;
}

/// Whether every condition overrides a value of the rig, so that a change would have no effect.
bool overridden_everywhere(const Campaign& campaign, int index) {
  return std::all_of(campaign.conditions.begin(), campaign.conditions.end(),
                     [&](const Condition& condition) {
                       const Overrides* level = level_overrides(campaign, condition);
                       return has_entry(condition.overrides, index) ||
                              (level != nullptr && has_entry(*level, index));
                     });
}

/// `--set name="value unit"`, as read.
struct Assignment {
  std::string option;  ///< as given, for messages
  std::string name;
  int index = 0;       ///< the parameter that changes
  double value = 0.0;  ///< SI
};

/// @throws UsageError  if the name is unknown, the unit is wrong or the value is outside the limits
Assignment read_assignment(const Campaign& campaign, std::string_view assignment) {
  Assignment read{fmt::format("--set {}", assignment), "", 0, 0.0};
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos || equals == 0) {
    throw UsageError(read.option + ": expected name=\"value unit\", such as mass=\"60 kg\"");
  }
  read.name = assignment.substr(0, equals);
  read.index = index_of(campaign, read.option, read.name);
  const model::ParameterSpec& spec = model::parameter_spec(campaign.rig.plant, read.index);
  try {
    read.value = parse_quantity(assignment.substr(equals + 1), spec.unit);
  } catch (const QuantityError& error) {
    throw UsageError(fmt::format("{}: {}", read.option, error.what()));
  }
  if (const auto problem = outside_limits(spec, read.value)) {
    throw UsageError(fmt::format("{}: {}", read.option, *problem));
  }
  return read;
}

}  // namespace

const Condition* Campaign::find(std::string_view id) const {
  const auto found = std::find_if(conditions.begin(), conditions.end(),
                                  [&](const Condition& condition) { return condition.id == id; });
  return found == conditions.end() ? nullptr : &*found;
}

const std::vector<AcceptanceLimit>& Campaign::limits(const Condition& condition) const {
  return condition.acceptance ? *condition.acceptance : acceptance;
}

bool Campaign::may_lack_limits(const Condition& condition, Channel channel) const {
  const auto names = [&](const std::vector<Channel>& stated) {
    return std::find(stated.begin(), stated.end(), channel) != stated.end();
  };
  return names(acceptance_bounds.not_judged) || names(condition.not_judged);
}

const ParameterSetting* Campaign::setting(int index) const {
  const auto found =
      std::find_if(parameters.begin(), parameters.end(),
                   [&](const ParameterSetting& entry) { return entry.index == index; });
  return found == parameters.end() ? nullptr : &*found;
}

bool Campaign::is_held_input(Channel channel) const {
  const auto found = channels.find(channel);
  return found != channels.end() && found->second.role == ChannelRole::input &&
         found->second.interpolation == Interpolation::hold;
}

void set_value(Campaign& campaign, std::string_view assignment) {
  const auto [option, name, index, value] = read_assignment(campaign, assignment);
  if (overridden_everywhere(campaign, index)) {
    throw UsageError(
        fmt::format("{}: every condition has a value of its own for {}, so a value "
                    "for the rig has no effect: change the leak levels or conditions",
                    option, name));
  }
  ParameterSetting changed = setting_or_new(campaign, index, value);
  changed.value = value;
  if (changed.between_repeats) changed.prior->mean = value;
  if (changed.fit) {
    if (const auto problem =
            complete_bounds(model::parameter_spec(campaign.rig.plant, index), changed)) {
      throw UsageError(fmt::format("{}: {}", option, *problem));
    }
  }
  setting_or_new(campaign, index, value) = changed;
}

void set_everywhere(Campaign& campaign, std::string_view assignment) {
  const Assignment read = read_assignment(campaign, assignment);
  const auto forget = [&](Overrides& overrides) {
    overrides.erase(std::remove_if(overrides.begin(), overrides.end(),
                                   [&](const auto& entry) { return entry.first == read.index; }),
                    overrides.end());
  };
  for (auto& [name, overrides] : campaign.leak_levels) forget(overrides);
  for (Condition& condition : campaign.conditions) forget(condition.overrides);
  ParameterSetting& changed = setting_or_new(campaign, read.index, read.value);
  changed.value = read.value;
  changed.fit = false;
  if (changed.between_repeats) changed.prior->mean = read.value;
}

void set_free(Campaign& campaign, const std::vector<std::string>& names) {
  Campaign changed = campaign;
  for (ParameterSetting& setting : changed.parameters) setting.fit = setting.between_repeats;
  for (const std::string& name : names) {
    const std::string option = fmt::format("--free {}", name);
    const int index = index_of(changed, option, name);
    const model::ParameterSpec& spec = model::parameter_spec(changed.rig.plant, index);
    if (const auto problem = cannot_be_fitted(spec)) {
      throw UsageError(fmt::format("{}: {}", option, *problem));
    }
    const double fallback = spec.default_value.value_or(std::numeric_limits<double>::quiet_NaN());
    ParameterSetting& setting = setting_or_new(changed, index, fallback);
    if (setting.between_repeats) {
      throw UsageError(
          fmt::format("{}: the campaign states its variation between repeats (between_repeats), so "
                      "its mean must be known",
                      option));
    }
    if (outside_limits(spec, setting.value)) {
      throw UsageError(
          fmt::format("{0}: {1} has no value to start from: expected one in the "
                      "campaign, or --set {1}=\"value {2}\"",
                      option, name, spec.unit));
    }
    setting.fit = true;
    if (const auto problem = complete_bounds(spec, setting)) {
      throw UsageError(fmt::format("{}: {}", option, *problem));
    }
  }
  campaign = std::move(changed);
}

void check_values(const Campaign& campaign) {
  if (const auto twice = gain_known_twice(campaign))
    throw UsageError(fmt::format("--set, --free: {}: {}", twice->where.text(), twice->message));
  for (const Condition& condition : campaign.conditions) {
    if (condition.use == Use::ignore) continue;
    if (const auto conflict = find_conflict(campaign.rig, values_in(campaign, condition))) {
      throw UsageError(
          fmt::format("--set, --free: condition \"{}\": {}", condition.id, conflict->message));
    }
  }
}

namespace {

/// Returns true if no fit and no uncertainty moves a parameter from its value in a condition.
bool is_fixed(const Campaign& campaign, const Condition& condition, int index) {
  const Overrides* level = level_overrides(campaign, condition);
  if (has_entry(condition.overrides, index) || (level != nullptr && has_entry(*level, index)))
    return true;
  const ParameterSetting* setting = campaign.setting(index);
  return setting == nullptr || (!setting->fit && !setting->prior);
}

/// Leaves out a valve lag that is zero and stays zero, so that the rig has no state for it. What
/// acts on that state keeps it.
void leave_out_zero_lag(const Campaign& campaign, const Condition& condition,
                        model::ParameterValues& values) {
  const int lag = model::parameter_index(campaign.rig.plant, "valve_time_constant");
  const auto at = static_cast<std::size_t>(lag);
  if (!values.given[at] || values.value[at] != 0.0) return;
  if (values.is_given("valve_rate_limit") || values.is_given("main_spool_gain")) return;
  if (is_fixed(campaign, condition, lag)) values.given[at] = false;
}

}  // namespace

model::ParameterValues values_in(const Campaign& campaign, const Condition& condition) {
  auto values = model::ParameterValues::defaults(campaign.rig.plant);
  for (const ParameterSetting& setting : campaign.parameters) {
    values.set(setting.index, setting.value);
  }
  if (const Overrides* level = level_overrides(campaign, condition)) {
    for (const auto& [index, value] : *level) values.set(index, value);
  }
  for (const auto& [index, value] : condition.overrides) values.set(index, value);
  if (condition.temperature_k && values.is_given("reference_temperature") &&
      !values.is_given("oil_temperature"))
    values.set("oil_temperature", *condition.temperature_k);
  leave_out_zero_lag(campaign, condition, values);
  return values;
}

}  // namespace rigcal::datasets
