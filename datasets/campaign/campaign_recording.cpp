#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/quantity.hpp"
#include "datasets/campaign/campaign_sections.hpp"

namespace rigcal::datasets {
namespace {

constexpr double kDefaultWindowS = 0.1;

constexpr std::string_view kCounts = "counts";

bool is_in_counts(const TomlNode& node) {
  const auto unit = node.find("unit");
  return unit && unit->is_string() && unit->string() == kCounts;
}

/// Reads a channel in converter counts. Counts have no unit, so they are not converted.
UnitConversion read_counts(const TomlNode& node) {
  for (const char* key : {"gain", "offset", "sd", "gain_sd", "offset_sd", "ignore_unit"}) {
    if (const auto entry = node.find(key))
      entry->fail("has no meaning for counts: expected the unit that the gain leads to");
  }
  return {};
}

/// Reads the conversion SI = conversion(gain * raw + offset). The offset is in the channel's unit.
UnitConversion read_conversion(const TomlNode& node, std::string_view si_unit, StatedUnit& stated) {
  const TomlNode unit =
      node.require("unit", fmt::format("the unit of the column, such as \"{}\"", si_unit));
  const std::string name = unit.name("a unit in quotes");
  UnitConversion conversion;
  try {
    conversion = unit_conversion(name, si_unit);
  } catch (const QuantityError& error) {
    unit.fail(error.what());
  }
  stated.unit = name;
  stated.where = unit.where();
  if (const auto entry = node.find("gain")) {
    stated.gain = entry->number();
    if (stated.gain == 0.0) entry->fail_type("a number other than zero");
    if (std::abs(*stated.gain) < kSizes.lower || std::abs(*stated.gain) > kSizes.upper)
      entry->fail_type(
          fmt::format("a number from {:g} to {:g}, of either sign", kSizes.lower, kSizes.upper));
  }
  const double gain = stated.gain.value_or(1.0);
  double offset = 0.0;
  if (const auto entry = node.find("offset")) {
    offset = entry->difference(name, {-kSizes.upper, kSizes.upper});
    stated.has_offset = true;
  }
  if (const auto entry = node.find("ignore_unit"))
    stated.ignored = entry->name("the unit that the file names, in quotes");
  return {conversion.scale * gain, conversion.scale * offset + conversion.offset};
}

ChannelRole default_role(Channel channel, Channel drive) {
  if (is_drive(channel)) return channel == drive ? ChannelRole::input : ChannelRole::ignore;
  switch (channel) {
    case Channel::supply_pressure:
    case Channel::tank_pressure:
      return ChannelRole::input;
    default:
      return info(channel).is_output ? ChannelRole::output : ChannelRole::ignore;
  }
}

/// Checks that the model can use a channel in this role.
void check_role(const TomlNode& node, Channel channel, ChannelRole role, Channel drive) {
  const bool drives = channel == drive;
  const bool can_be_input = drives || channel == Channel::supply_pressure ||
                            channel == Channel::tank_pressure || channel == Channel::force;
  const bool open_loop = drive == Channel::command || drive == Channel::pilot_pressure;
  const bool can_be_output = info(channel).is_output || (channel == Channel::command && !open_loop);
  if (role == ChannelRole::input && !can_be_input) {
    const std::string loop = drive == Channel::command ? "without a controller"
                             : drive == Channel::pilot_pressure
                                 ? "where pilot_gain makes the pilot pressure the drive"
                                 : fmt::format("of a rig that follows {}", info(drive).key);
    node.fail(fmt::format("{} cannot be an input {}: expected \"output\" or \"ignore\"",
                          info(channel).key, loop));
  }
  if (role == ChannelRole::output && !can_be_output) {
    node.fail(fmt::format("the model does not compute {}: expected \"input\" or \"ignore\"",
                          info(channel).key));
  }
}

ChannelSetting read_channel(const TomlNode& node, Channel channel, Channel drive) {
  node.allow_only({"column", "minus", "unit", "ignore_unit", "gain", "offset", "sd", "gain_sd",
                   "offset_sd", "role", "interpolation", "recognise"});
  ChannelSetting setting;
  setting.channel = channel;
  if (const auto column = node.find("column")) setting.column = column->name("a column name");
  if (const auto minus = node.find("minus")) {
    setting.minus = minus->name("a column name");
    if (setting.column.empty())
      minus->fail("nothing to take this column off: expected a column as well");
  }
  setting.in_counts = is_in_counts(node);
  setting.to_si = setting.in_counts ? read_counts(node)
                                    : read_conversion(node, info(channel).unit, setting.stated);
  if (const auto sd = node.find("sd")) {
    setting.sd = sd->difference(info(channel).unit, kStandardDeviations);
  }
  if (const auto sd = node.find("gain_sd")) {
    setting.gain_sd = sd->number();
    setting.gain_sd_where = sd->where();
    if (!(setting.gain_sd >= 0.0 && setting.gain_sd < 1.0))
      sd->fail_type("a relative standard uncertainty, at least 0 and below 1");
  }
  if (const auto sd = node.find("offset_sd"))
    setting.offset_sd = sd->difference(info(channel).unit, kDisturbances);
  setting.role = default_role(channel, drive);
  if (const auto role = node.find("role")) {
    setting.role = role->choice<ChannelRole>({{"input", ChannelRole::input},
                                              {"output", ChannelRole::output},
                                              {"ignore", ChannelRole::ignore}});
    check_role(*role, channel, setting.role, drive);
  }
  if (const auto interpolation = node.find("interpolation")) {
    setting.interpolation = interpolation->choice<Interpolation>(
        {{"hold", Interpolation::hold}, {"linear", Interpolation::linear}});
  }
  if (const auto recognise = node.find("recognise")) {
    setting.recognise = recognise->boolean();
    if (channel != Channel::reference && channel != Channel::command &&
        channel != Channel::pilot_pressure)
      recognise->fail("has a meaning only for a drive: expected it of reference or command");
  }
  return setting;
}

void read_channels(const TomlNode& table, Campaign& campaign) {
  for (const auto& [key, node] : table.entries()) {
    if (key == "time") {
      node.allow_only({"column", "unit", "ignore_unit", "gain", "offset"});
      campaign.time_column =
          node.require("column", "the name of the time column").name("a column name");
      campaign.time_in_counts = is_in_counts(node);
      campaign.time_to_s = campaign.time_in_counts
                               ? read_counts(node)
                               : read_conversion(node, "s", campaign.stated_time);
      continue;
    }
    const Channel channel = read_channel_key(table, key);
    campaign.channels.emplace(channel, read_channel(node, channel, drive_channel(campaign)));
  }
}

/// Reads `before`. In a settled loop the reference fixes the initial position, so "steady" excludes
/// `initial`.
void read_before(const TomlNode& node, Campaign& campaign) {
  campaign.before_stated = true;
  campaign.rig.before = node.choice<model::Before>({{"hold", model::Before::hold},
                                                    {"rest", model::Before::rest},
                                                    {"steady", model::Before::steady}});
  if (campaign.rig.before == model::Before::steady && campaign.initial != InitialMode::rest &&
      campaign.rig.controller == model::ControllerKind::pid)
    node.fail(
        "\"steady\" has a loop begin where it settles at the first reference: expected it without "
        "`initial`, or before = \"rest\" or \"hold\" with it");
}

void read_holes(const TomlNode& node, Campaign& campaign) {
  const auto holes = node.find("holes");
  const bool bridge = holes && holes->choice<bool>({{"refuse", false}, {"bridge", true}});
  if (bridge) {
    campaign.longest_bridge_s =
        node.require("longest_hole", "holes = \"bridge\" goes no further, such as \"50 ms\"")
            .quantity("s", kDurations_s);
  } else if (const auto longest = node.find("longest_hole")) {
    longest->fail("has a meaning only together with holes = \"bridge\"");
  }
}

}  // namespace

void read_recording(const TomlNode& node, Campaign& campaign) {
  node.allow_only({"initial", "initial_window", "before", "separator", "decimate_to", "spikes",
                   "holes", "longest_hole", "channels"});
  if (const auto initial = node.find("initial")) {
    campaign.initial = initial->choice<InitialMode>(
        {{"rest", InitialMode::rest}, {"record", InitialMode::record}, {"fit", InitialMode::fit}});
  }
  campaign.rig.initial = campaign.initial == InitialMode::rest ? model::InitialState::rest
                                                               : model::InitialState::given;
  if (const auto before = node.find("before")) read_before(*before, campaign);
  campaign.initial_window_s = kDefaultWindowS;
  if (const auto window = node.find("initial_window")) {
    campaign.initial_window_s = window->quantity("s", kDurations_s);
    if (campaign.initial == InitialMode::rest) {
      window->fail("has no meaning where all states start at zero: expected initial = \"record\"");
    }
  }
  if (const auto separator = node.find("separator")) {
    campaign.separator =
        separator->choice<char>({{",", ','}, {";", ';'}, {"\t", '\t'}, {" ", ' '}});
  }
  if (const auto rate = node.find("decimate_to")) {
    campaign.decimate_to_hz = rate->quantity("Hz", kSampleRates_hz);
  }
  if (const auto spikes = node.find("spikes")) {
    campaign.spikes = spikes->choice<SpikeTreatment>(
        {{"report", SpikeTreatment::report}, {"exclude", SpikeTreatment::exclude}});
  }
  read_holes(node, campaign);
  if (const auto channels = node.find("channels")) read_channels(*channels, campaign);
}

Channel read_channel_key(const TomlNode& table, const std::string& key) {
  const auto channel = channel_from_key(key);
  if (channel) return *channel;
  std::vector<std::string> known;
  for (const ChannelInfo& row : channel_table()) known.emplace_back(row.key);
  table.fail_unknown(key, "channel", known);
}

std::vector<Channel> output_channels(const Campaign& campaign) {
  std::vector<Channel> outputs;
  for (const auto& [channel, setting] : campaign.channels) {
    if (setting.role == ChannelRole::output) outputs.push_back(channel);
  }
  return outputs;
}

Channel drive_channel(const model::Rig& rig) {
  if (rig.controller == model::ControllerKind::none)
    return rig.pilot ? Channel::pilot_pressure : Channel::command;
  switch (rig.feedback) {
    case model::Feedback::position:
      return Channel::reference;
    case model::Feedback::force:
      return Channel::force_reference;
    case model::Feedback::load_pressure:
      return Channel::load_pressure_reference;
    case model::Feedback::acceleration:
      return Channel::acceleration_reference;
  }
  return Channel::reference;
}

Channel motion_channel(const model::Rig& rig) {
  return rig.plant == model::PlantKind::linkage ? Channel::angle : Channel::position;
}

}  // namespace rigcal::datasets
