#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "datasets/campaign/campaign_parameters.hpp"
#include "datasets/campaign/campaign_sections.hpp"

namespace rigcal::datasets {
namespace {

[[noreturn]] void fail(const Condition& condition, const std::string& message) {
  throw InputError(condition.where,
                   fmt::format("key 'condition \"{}\"': {}", condition.id, message));
}

bool is_compared(const Condition& condition) {
  return condition.use == Use::fit || condition.use == Use::validate;
}

bool overrides(const Overrides& values, int index) {
  return std::any_of(values.begin(), values.end(),
                     [&](const auto& entry) { return entry.first == index; });
}

bool is_initial(const Campaign& campaign, int index) {
  return model::parameter_spec(campaign.rig.plant, index).kind == model::ParameterKind::initial;
}

void check_initial(const Campaign& campaign) {
  if (campaign.initial == InitialMode::fit) return;
  const std::string message =
      "initial values have an effect only with initial = \"fit\" in [recording]: \"rest\" starts "
      "from zero, \"record\" from the record";
  for (const ParameterSetting& setting : campaign.parameters) {
    if (!is_initial(campaign, setting.index)) continue;
    throw InputError(
        setting.where,
        fmt::format("key 'rig.parameters.{}': {}",
                    model::parameter_spec(campaign.rig.plant, setting.index).key, message));
  }
  for (const Condition& condition : campaign.conditions) {
    for (const auto& entry : condition.overrides) {
      if (is_initial(campaign, entry.first)) fail(condition, message);
    }
  }
}

void check_controller(const Campaign& campaign) {
  if (campaign.rig.controller != model::ControllerKind::none) return;
  for (const Condition& condition : campaign.conditions) {
    for (const auto& entry : condition.overrides) {
      const model::ParameterSpec& spec = model::parameter_spec(campaign.rig.plant, entry.first);
      if (spec.kind != model::ParameterKind::controller) continue;
      fail(condition, fmt::format("controller.{} is given, but the rig has no controller: expected "
                                  "type = \"pid\" in [rig.controller]",
                                  spec.key));
    }
  }
}

void check_tank(const Campaign& campaign) {
  const auto tank = campaign.channels.find(Channel::tank_pressure);
  if (tank == campaign.channels.end() || tank->second.role != ChannelRole::input ||
      campaign.rig.plant != model::PlantKind::load_pressure) {
    return;
  }
  throw InputError({campaign.file.string()},
                   "key 'recording.channels.tank_pressure': the plant load_pressure counts its "
                   "pressures from the tank's: expected role = \"ignore\", or "
                   "model = \"two_chamber\"");
}

/// Checks that the channels suit the plant: angle and torque for a linkage; position, acceleration
/// and force for every other plant.
void check_motion(const Campaign& campaign) {
  const bool turns = campaign.rig.plant == model::PlantKind::linkage;
  for (const auto& [channel, setting] : campaign.channels) {
    if (setting.role == ChannelRole::ignore) continue;
    const bool slides = channel == Channel::force || channel == Channel::payload_acceleration ||
                        channel == Channel::position || channel == Channel::acceleration;
    const bool of_joint = channel == Channel::angle || channel == Channel::torque;
    if (turns ? slides : of_joint) {
      throw InputError(
          {campaign.file.string()},
          fmt::format("key 'recording.channels.{}': the plant {} {}: expected {}, or role = "
                      "\"ignore\"",
                      info(channel).key, to_string(campaign.rig.plant),
                      turns ? "moves an arm, so its motion is the angle of the joint"
                            : "moves a load along a line, and has no joint",
                      channel == Channel::force    ? "the channel torque (unit \"N m\")"
                      : turns                      ? "the channel angle (unit \"deg\" or \"rad\")"
                      : channel == Channel::torque ? "the channel force, model = \"linkage\""
                                                   : "the channel position, model = \"linkage\""));
    }
  }
}

/// Checks that the oil has a temperature if its properties depend on it: as a parameter, or
/// recorded.
void check_temperature(const Campaign& campaign, const Condition& condition) {
  const auto values = values_in(campaign, condition);
  const auto channel = campaign.channels.find(Channel::temperature);
  const bool recorded =
      channel != campaign.channels.end() && channel->second.role == ChannelRole::input;
  const bool follows = values.is_given("reference_temperature");
  if (recorded && !follows)
    throw InputError({campaign.file.string()},
                     "key 'recording.channels.temperature': no property of the oil depends on it: "
                     "expected reference_temperature in [rig.parameters], or role = \"ignore\"");
  if (follows && !recorded && !values.is_given("oil_temperature"))
    fail(condition,
         "reference_temperature is given, but no temperature of the oil: expected oil_temperature, "
         "temperature in the condition, or the channel temperature with role = \"input\"");
}

void check_values(const Campaign& campaign, const Condition& condition) {
  const auto conflict = find_conflict(campaign.rig, values_in(campaign, condition));
  if (!conflict) return;
  const int index = model::parameter_index(campaign.rig.plant, conflict->key);
  const ParameterSetting* setting = index < 0 ? nullptr : campaign.setting(index);
  if (setting != nullptr && !overrides(condition.overrides, index)) {
    throw InputError(setting->where, fmt::format("key '{}': {}", conflict->key, conflict->message));
  }
  fail(condition, conflict->message);
}

void check_levels(const Campaign& campaign, const Condition& condition) {
  if (!is_compared(condition) || condition.leak_level) return;
  for (const ParameterSetting& setting : campaign.parameters) {
    if (!setting.fit || setting.scope != Scope::leak_level) continue;
    if (overrides(condition.overrides, setting.index)) continue;
    fail(condition, fmt::format("has no leak_level, but {} has one value per leak level: expected "
                                "leak_level = \"...\"",
                                model::parameter_spec(campaign.rig.plant, setting.index).key));
  }
}

bool carries(const Campaign& campaign, const RepeatPattern& pattern, Channel channel) {
  const auto setting = campaign.channels.find(channel);
  return setting != campaign.channels.end() &&
         (!setting->second.column.empty() || pattern.columns.contains(channel));
}

bool carries(const Campaign& campaign, const Condition& condition, Channel channel) {
  if (condition.averaged) return carries(campaign, RepeatPattern{}, channel);
  return std::any_of(
      condition.repeats.begin(), condition.repeats.end(),
      [&](const RepeatPattern& pattern) { return carries(campaign, pattern, channel); });
}

/// Checks that a condition with a recorded drive has a record with the drive as input channel.
void check_recorded_drive(const Campaign& campaign, const Condition& condition) {
  if (condition.waveform != Waveform::recorded) return;
  if (!condition.has_record()) {
    fail(condition,
         "the waveform \"recorded\" needs a record: expected repeats = [\"...\"] or "
         "averaged = \"...\"");
  }
  const Channel drive = drive_channel(campaign);
  const bool pid = campaign.rig.controller == model::ControllerKind::pid;
  const std::string needed =
      fmt::format("the waveform \"recorded\" needs the channel {} {}", info(drive).key,
                  pid ? "where a pid controller is in the loop"
                      : "where no controller is in the "
                        "loop");
  if (!carries(campaign, condition, drive)) {
    fail(condition, needed + ": expected it, with column and unit, in [recording.channels]");
  }
  if (campaign.channels.at(drive).role != ChannelRole::input) {
    fail(condition, needed + ": expected the role \"input\" for it");
  }
}

/// Returns the column of a channel in the files of a pattern; empty if it has none.
std::string column_in(const Campaign& campaign, const RepeatPattern& pattern, Channel channel) {
  const auto own = pattern.columns.find(channel);
  return own != pattern.columns.end() ? own->second : campaign.channels.at(channel).column;
}

/// Checks that a recorded load is not the column of the drive: a loop on force or torque follows
/// its reference, and the load is what a transducer on the other side of the rig reads.
void check_recorded_load(const Campaign& campaign, const Condition& condition) {
  const Channel load = external_load_channel(campaign);
  const Channel drive = drive_channel(campaign);
  const auto setting = campaign.channels.find(load);
  const auto driving = campaign.channels.find(drive);
  if (setting == campaign.channels.end() || setting->second.role != ChannelRole::input ||
      driving == campaign.channels.end() || setting->second.minus != driving->second.minus)
    return;
  std::vector<RepeatPattern> patterns = condition.repeats;
  if (condition.averaged) patterns.push_back({*condition.averaged, {}, {}});
  for (const RepeatPattern& pattern : patterns) {
    const std::string column = column_in(campaign, pattern, load);
    if (column.empty() || column != column_in(campaign, pattern, drive)) continue;
    fail(condition,
         fmt::format("the column '{}' is {} and, with role = \"input\", the load {}: expected two "
                     "columns, or role = \"output\" for {} if the rig's own transducer reads it",
                     column, info(drive).key, info(load).key, info(load).key));
  }
}

void check_record(const Campaign& campaign, const Condition& condition) {
  check_recorded_drive(campaign, condition);
  check_recorded_load(campaign, condition);
  if (condition.has_record()) {
    if (campaign.time_column.empty()) {
      fail(condition,
           "has records, but their time column is unknown: expected time = { column = \"...\", "
           "unit = \"s\" } in [recording.channels]");
    }
    const auto outputs = output_channels(campaign);
    const bool any = std::any_of(outputs.begin(), outputs.end(), [&](Channel channel) {
      return carries(campaign, condition, channel);
    });
    if (is_compared(condition) && !any) {
      fail(condition,
           "its records have no output channel to compare with the model: expected an output "
           "channel such as position or angle in [recording.channels]");
    }
    return;
  }
  if (is_compared(condition) && !(condition.duration_s && condition.sample_rate_hz)) {
    fail(condition,
         "has neither a record nor both duration and sample_rate: expected "
         "repeats = [\"...\"], or duration = \"10 s\" and sample_rate = \"1000 Hz\"");
  }
}

void add_counted(const Campaign& campaign, const Condition& condition,
                 std::vector<std::string>& lacks) {
  std::vector<std::string_view> counted;
  for (const auto& [channel, setting] : campaign.channels) {
    if (setting.in_counts && carries(campaign, condition, channel))
      counted.push_back(info(channel).key);
  }
  if (counted.empty()) return;
  lacks.push_back(
      fmt::format("{} {} raw counts of a converter: without a calibration (unit and gain) they "
                  "cannot be compared with the model",
                  fmt::join(counted, ", "), counted.size() == 1 ? "has" : "have"));
}

void add_missing_drive(const Campaign& campaign, const Condition& condition,
                       std::vector<std::string>& lacks) {
  const Channel drive = drive_channel(campaign);
  if (condition.waveform != Waveform::recorded || carries(campaign, condition, drive)) return;
  lacks.push_back(fmt::format(
      "the waveform is recorded, but no channel {} contains it: the command to the machine is "
      "not known, so the healthy model cannot be run under the same {}",
      info(drive).key, info(drive).key));
}

}  // namespace

std::optional<GainKnownTwice> gain_known_twice(const Campaign& campaign) {
  for (const auto& [channel, setting] : campaign.channels) {
    if (!setting.gain_sd_where || !(setting.gain_sd > 0.0)) continue;
    const std::string key = fmt::format("{}_gain", info(channel).key);
    const int index = model::parameter_index(campaign.rig.plant, key);
    const ParameterSetting* gain = index < 0 ? nullptr : campaign.setting(index);
    if (gain == nullptr || !(gain->fit || gain->prior)) continue;
    return GainKnownTwice{
        *setting.gain_sd_where,
        fmt::format(
            "key 'recording.channels.{}.gain_sd': {} {} too{}: the uncertainty of this gain "
            "would count twice: expected one of the two",
            info(channel).key, key, gain->fit ? "is estimated" : "has a prior",
            gain->where.line > 0 ? fmt::format(" ({})", gain->where.text()) : "")};
  }
  return std::nullopt;
}

std::vector<std::string> lacks_for_model(const Campaign& campaign, const Condition& condition) {
  std::vector<std::string> lacks;
  const auto values = values_in(campaign, condition);
  if (const auto missing = values.missing(); !missing.empty()) {
    lacks.push_back(fmt::format("{} of the rig is unknown: expected values in [rig.parameters]",
                                fmt::join(missing, ", ")));
  } else if (const auto conflict = find_conflict(campaign.rig, values)) {
    lacks.push_back(fmt::format("{}: {}", conflict->key, conflict->message));
  }
  add_missing_drive(campaign, condition, lacks);
  if (!condition.has_record()) {
    lacks.emplace_back("it has no record");
    return lacks;
  }
  if (campaign.time_column.empty()) {
    lacks.emplace_back("no column has the time of its samples");
  } else if (campaign.time_in_counts) {
    lacks.emplace_back("its samples are numbered, but the sampling rate is unknown");
  }
  const auto outputs = output_channels(campaign);
  if (std::none_of(outputs.begin(), outputs.end(),
                   [&](Channel channel) { return carries(campaign, condition, channel); })) {
    lacks.emplace_back("no recorded channel can be compared with the model");
  }
  add_counted(campaign, condition, lacks);
  return lacks;
}

void check_campaign(const Campaign& campaign, const Location& start) {
  if (campaign.conditions.empty()) {
    throw InputError(start, "no condition: expected at least one [[condition]]");
  }
  check_initial(campaign);
  check_controller(campaign);
  check_tank(campaign);
  check_motion(campaign);
  if (const auto twice = gain_known_twice(campaign)) throw InputError(twice->where, twice->message);
  for (const Condition& condition : campaign.conditions) {
    if (condition.use == Use::ignore) continue;
    if (condition.use == Use::diagnose) {
      // The diagnosis itself reports all missing values at once.
      if (values_in(campaign, condition).missing().empty()) check_values(campaign, condition);
      continue;
    }
    check_values(campaign, condition);
    check_temperature(campaign, condition);
    check_levels(campaign, condition);
    check_record(campaign, condition);
  }
}

}  // namespace rigcal::datasets
