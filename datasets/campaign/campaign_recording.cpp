#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/quantity.hpp"
#include "datasets/campaign/campaign_sections.hpp"

namespace rigcal::datasets {
namespace {

constexpr std::string_view kCounts = "counts";

bool is_in_counts(const TomlNode& node) {
  const auto unit = node.find("unit");
  return unit && unit->is_string() && unit->string() == kCounts;
}

/// Reads a channel in converter counts. Counts have no unit, so they are not converted.
UnitConversion read_counts(const TomlNode& node) {
  for (const char* key :
       {"gain", "offset", "sd", "gain_sd", "offset_sd", "ignore_unit", "full_scale"}) {
    if (const auto entry = node.find(key))
      entry->fail(
          "is not a unit of the physical value (counts): expected the unit that the gain converts "
          "to");
  }
  return {};
}

bool is_convertible(std::string_view from, std::string_view to) {
  try {
    unit_conversion(from, to);
    return true;
  } catch (const QuantityError&) {
    return false;
  }
}

/// Reads the full scale of a command in % or mA, in that unit; 0 for any other channel and unit.
double read_full_scale(const TomlNode& node, Channel channel, const std::string& unit) {
  const auto entry = node.find("full_scale");
  const bool share = is_convertible(unit, "1");
  if (channel != Channel::command || !(share || is_convertible(unit, "A"))) {
    if (entry) entry->fail("is meaningful only for a command in % or mA: remove it");
    return 0.0;
  }
  if (share && !entry) return unit_conversion("1", unit).scale;  // 100 %
  return node
      .require("full_scale", fmt::format("the current at which the valve is fully open, such as "
                                         "\"40 mA\" (equivalent to {:g} V)",
                                         kFullCommand_v))
      .difference(unit, kSizes);
}

/// Reads the conversion SI = conversion(gain * raw + offset). The offset is in the channel's unit.
///
/// @param channel  std::nullopt: the time
UnitConversion read_conversion(const TomlNode& node, std::optional<Channel> channel,
                               StatedUnit& stated) {
  const std::string_view si_unit = channel ? info(*channel).unit : "s";
  const TomlNode unit =
      node.require("unit", fmt::format("the unit of the column, such as \"{}\"", si_unit));
  const std::string name = unit.name("a unit in quotes");
  stated.unit = name;
  stated.where = unit.where();
  if (channel) stated.full_scale = read_full_scale(node, *channel, name);
  UnitConversion conversion;
  try {
    conversion = stated_conversion(stated, si_unit);
  } catch (const QuantityError& error) {
    unit.fail(error.what());
  }
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
    case Channel::base_acceleration:
      return ChannelRole::input;
    default:
      return info(channel).is_output ? ChannelRole::output : ChannelRole::ignore;
  }
}

/// Checks that the model can use a channel in this role.
void check_role(const TomlNode& node, Channel channel, ChannelRole role, Channel drive) {
  const bool drives = channel == drive;
  const bool can_be_input = drives || channel == Channel::supply_pressure ||
                            channel == Channel::tank_pressure || channel == Channel::force ||
                            channel == Channel::torque || channel == Channel::base_acceleration ||
                            channel == Channel::temperature;
  const bool open_loop = drive == Channel::command || drive == Channel::pilot_pressure;
  const bool can_be_output = info(channel).is_output || (channel == Channel::command && !open_loop);
  if (role == ChannelRole::input && !can_be_input) {
    const std::string loop = !is_drive(channel)          ? ""
                             : drive == Channel::command ? " without a controller"
                             : drive == Channel::pilot_pressure
                                 ? " where pilot_gain makes the pilot pressure the drive"
                                 : fmt::format(" of a rig controlled by {}", info(drive).key);
    node.fail(fmt::format("{} cannot be an input{}: expected \"output\" or \"ignore\"",
                          info(channel).key, loop));
  }
  if (role == ChannelRole::output && !can_be_output) {
    node.fail(fmt::format("the model does not compute {}: expected \"input\" or \"ignore\"",
                          info(channel).key));
  }
}

/// Keys that a channel has in common with `time`.
std::vector<KeyRow<ChannelSetting>> column_rows() {
  using Row = KeyRow<ChannelSetting>;
  const auto text = plain_form(KeyForm::Kind::text);
  return {
      Row::described("column", text,
                     {.doc = "Name in the header, without its unit; for other formats see below. A "
                             "channel without one is read only if `columns` of a repeat names its "
                             "column; `time` needs one",
                      .otherwise = "none",
                      .example = "\"x_mm\""}),
      Row::described("unit", text,
                     {.doc = "Unit of the column; compared with the one in the file (below)",
                      .example = "\"mm\"",
                      .needed = "the unit of the column"}),
      Row::described("ignore_unit", text,
                     {.doc = "Unit that the file wrongly states for the column",
                      .otherwise = "none",
                      .example = "\"psi\""}),
      Row::described("gain", number_form({-kSizes.upper, kSizes.upper}),
                     {.doc = "Physical value = gain * number in the file + offset",
                      .otherwise = "`1`",
                      .example = "-1.0"}),
      Row::described("offset", plain_form(KeyForm::Kind::quantity),
                     {.doc = "Added after the gain", .otherwise = "0"}),
  };
}

/// @param unit  SI unit of the channel; empty: any unit
KeyTable<ChannelSetting> channel_keys(std::string_view unit) {
  using Row = KeyRow<ChannelSetting>;
  const KeyForm quantity = unit.empty() ? plain_form(KeyForm::Kind::quantity) : quantity_form(unit);
  std::vector<Row> rows = column_rows();
  rows.back().info.form = quantity;
  rows.insert(rows.begin() + 1,
              Row::described(
                  "minus", plain_form(KeyForm::Kind::text),
                  {.doc = "Second column, which is subtracted from `column` sample by sample: "
                          "`load_pressure = { column = \"p_a\", minus = \"p_b\", unit = \"bar\" }`",
                   .otherwise = "none",
                   .example = "\"x_2\""}));
  const std::vector more{
      Row::described("full_scale", plain_form(KeyForm::Kind::quantity),
                     {.doc = "For a `command` in % or mA: the value that corresponds to 10 V",
                      .otherwise = "`\"100 %\"`; needed for a current",
                      .example = "\"40 mA\""}),
      Row::number(
          "gain_sd", &ChannelSetting::gain_sd,
          NumberLimits{
              {0.0, 1.0}, "a relative standard uncertainty, at least 0 and below 1", false, true},
          {.doc = "Standard uncertainty of the sensor's gain, relative (0.002: 0.2 %), from its "
                  "certificate; widens the uncertainty of scores, and the intervals of the "
                  "estimates as a prior of `position_gain` would. An error together with a "
                  "`position_gain` that is estimated or has a prior"}),
      Row::custom("offset_sd", quantity,
                  [](const TomlNode& node, ChannelSetting& setting) {
                    setting.offset_sd = node.difference(info(setting.channel).unit, kDisturbances);
                  },
                  {.doc = "The same for its offset (`position_offset`)", .otherwise = "0"}),
      Row::custom("sd", quantity,
                  [](const TomlNode& node, ChannelSetting& setting) {
                    setting.sd = node.difference(info(setting.channel).unit, kStandardDeviations);
                  },
                  {.doc = "Standard deviation of the noise of a sample, as a physical value (after "
                          "the gain); needed only without repeats. Without both, `fit` estimates "
                          "the noise from the residual of the channel over all such conditions",
                   .otherwise = "from the repeats"}),
      Row::word<ChannelRole>("role", &ChannelSetting::role,
                             {.doc = "Input of the model, or output (compared with the model)",
                              .otherwise = "by channel (below)"}),
      Row::flag("recognise", &ChannelSetting::recognise,
                {.doc = "For `reference` or `command`: a recorded drive that matches a generated "
                        "one is simulated as generated (*Drives that are recognised*)"}),
      Row::word<Interpolation>("interpolation", &ChannelSetting::interpolation,
                               {.doc = "Course of an input between samples"}),
  };
  rows.insert(rows.end(), more.begin(), more.end());
  for (Row& row : rows)
    if (row.info.form.kind == KeyForm::Kind::quantity) row.info.form.name = "quantity";
  return KeyTable<ChannelSetting>(std::move(rows));
}

ChannelSetting read_channel(const TomlNode& node, Channel channel, Channel drive) {
  static const KeyTable<ChannelSetting> keys = channel_keys("");
  node.allow_only(keys.names());
  ChannelSetting setting;
  setting.channel = channel;
  if (const auto column = node.find("column")) setting.column = column->name("a column name");
  if (const auto minus = node.find("minus")) {
    setting.minus = minus->name("a column name");
    if (setting.column.empty())
      minus->fail("there is no column to subtract it from: expected a column as well");
  }
  setting.in_counts = is_in_counts(node);
  setting.to_si =
      setting.in_counts ? read_counts(node) : read_conversion(node, channel, setting.stated);
  setting.role = default_role(channel, drive);
  keys.read_rows(node, setting);
  if (const auto sd = node.find("gain_sd")) setting.gain_sd_where = sd->where();
  if (const auto role = node.find("role")) check_role(*role, channel, setting.role, drive);
  if (const auto recognise = node.find("recognise"); recognise && !is_drive(channel))
    recognise->fail("is meaningful only for a drive: expected with reference or command");
  return setting;
}

void read_channels(const TomlNode& table, Campaign& campaign) {
  static const KeyTable<ChannelSetting> time_keys(column_rows());
  for (const auto& [key, node] : table.entries()) {
    if (key == "time") {
      node.allow_only(time_keys.names());
      campaign.time_column =
          node.require("column", "the name of the time column").name("a column name");
      campaign.time_in_counts = is_in_counts(node);
      campaign.time_to_s = campaign.time_in_counts
                               ? read_counts(node)
                               : read_conversion(node, std::nullopt, campaign.stated_time);
      continue;
    }
    if (!channel_from_key(key)) {
      std::vector<std::string> known{"time"};
      for (const ChannelInfo& row : channel_table()) known.emplace_back(row.key);
      table.fail_unknown(key, "channel", known);
    }
    const Channel channel = *channel_from_key(key);
    const auto& setting =
        campaign.channels.emplace(channel, read_channel(node, channel, drive_channel(campaign)))
            .first->second;
    if (channel == Channel::base_acceleration && setting.role == ChannelRole::input &&
        campaign.rig.plant == model::PlantKind::linkage)
      node.fail(
          "the plant linkage moves an arm, and the effect of a moving base depends on lengths that "
          "the model does not contain: expected role = \"ignore\"");
  }
}

KeyForm recorded_channels_form() {
  std::vector<KeyRow<ChannelSetting>> time = column_rows();
  time.front().info.needed = true;
  time[1].info.example = "\"s\"";
  time.back().info.form.units = {"s"};
  std::vector<CampaignKey> keys{{"time", table_form(KeyTable<ChannelSetting>(time).keys()),
                                 "Column of the times of the samples"}};
  for (const ChannelInfo& channel : channel_table())
    keys.push_back({std::string(channel.key), table_form(channel_keys(channel.unit).keys()),
                    fmt::format("Column of this channel, {}", channel.unit)});
  return table_form(std::move(keys));
}

/// Rejects `before = "steady"` together with `initial` in a closed loop: in a settled loop the
/// reference fixes the initial position.
void check_before(const TomlNode& node, const Campaign& campaign) {
  if (campaign.rig.before == model::Before::steady && campaign.initial != InitialMode::rest &&
      campaign.rig.controller == model::ControllerKind::pid)
    node.fail(
        "\"steady\" starts a loop in its steady state at the first reference: expected without "
        "`initial`, or before = \"rest\" or \"hold\" with it");
}

/// Accepted values of `holes`: true bridges the gaps.
const Words<bool>& hole_words() {
  static const Words<bool> words{{"refuse", false}, {"bridge", true}};
  return words;
}

void read_holes(const TomlNode& node, Campaign& campaign) {
  const auto holes = node.find("holes");
  const bool bridge = holes && holes->choice(hole_words());
  if (bridge) {
    campaign.longest_bridge_s =
        node.require("longest_hole",
                     "longest hole that holes = \"bridge\" accepts, such as \"50 ms\"")
            .quantity("s", kDurations_s);
  } else if (const auto longest = node.find("longest_hole")) {
    longest->fail("is meaningful only with holes = \"bridge\"");
  }
}

}  // namespace

const KeyTable<Campaign>& recording_keys() {
  using Row = KeyRow<Campaign>;
  const auto before = [](Campaign& campaign) -> model::Before& { return campaign.rig.before; };
  static const KeyTable<Campaign> keys({
      Row::word<InitialMode>(
          "initial", &Campaign::initial,
          {.doc = "State at the first sample. `\"rest\"`: all states zero (two chambers: the "
                  "pressures balance the load, at half the supply). `\"record\"`: mean over "
                  "`initial_window`, within which the piston must be at rest (a warning is given "
                  "if it moves). `\"fit\"`: estimated per condition"}),
      Row::word<model::Before>(
          "before", before,
          {{"hold", model::Before::hold},
           {"rest", model::Before::rest},
           {"steady", model::Before::steady}},
          {.doc = "The drive before its first sample (below)",
           .example = "\"rest\"",
           .hint = "the drive was neutral until the first sample: a record that begins at its "
                   "step"}),
      Row::quantity("initial_window", &Campaign::initial_window_s, "s", kDurations_s,
                    {.doc = "Only with `initial = \"record\"` or `\"fit\"`"}),
      Row::word<char>(
          "separator", &Campaign::separator, {{",", ','}, {";", ';'}, {"\t", '\t'}, {" ", ' '}},
          {.doc = "Separator of columns in a CSV file; a blank means any number of blanks",
           .otherwise = "detected"}),
      Row::quantity(
          "decimate_to", &Campaign::decimate_to_hz, "Hz", kSampleRates_hz,
          {.doc = "Records with a higher rate are filtered and decimated to this rate (below)",
           .otherwise = "none",
           .example = "\"1 kHz\"",
           .hint = "if the sampling rate is higher than the model needs"}),
      Row::word<SpikeTreatment>("spikes", &Campaign::spikes,
                                {.doc = "With `\"exclude\"` each spike is replaced by a line "
                                        "between its neighbours (below)"}),
      Row::described("holes", word_form(words_of(hole_words())),
                     {.doc = "With `\"bridge\"` missing samples are ignored, and the samples on "
                             "either side are used (*Times*)",
                      .otherwise = "`\"refuse\"`"}),
      Row::described("longest_hole", quantity_form("s"),
                     {.doc = "Longer holes are still an error",
                      .otherwise = "needed with `holes = \"bridge\"`",
                      .example = "\"50 ms\""}),
      Row::described("channels", recorded_channels_form(),
                     {.doc = "The columns of the files, by channel", .otherwise = "none"}),
  });
  return keys;
}

void read_recording(const TomlNode& node, Campaign& campaign) {
  recording_keys().read(node, campaign);
  campaign.rig.initial = campaign.initial == InitialMode::rest ? model::InitialState::rest
                                                               : model::InitialState::given;
  if (const auto before = node.find("before")) {
    campaign.before_stated = true;
    check_before(*before, campaign);
  }
  if (const auto window = node.find("initial_window");
      window && campaign.initial == InitialMode::rest)
    window->fail("is meaningless if all states start at zero: expected initial = \"record\"");
  read_holes(node, campaign);
  if (const auto channels = node.find("channels")) read_channels(*channels, campaign);
}

std::vector<std::string> output_channel_names() {
  std::vector<std::string> names;
  for (const ChannelInfo& channel : channel_table())
    if (channel.is_output) names.emplace_back(channel.key);
  names.emplace_back(info(Channel::command).key);  // the output of a controller
  return names;
}

KeyForm channels_form(std::string name) {
  KeyForm form = plain_form(KeyForm::Kind::table, std::move(name));
  for (const ChannelInfo& channel : channel_table())
    form.keys.push_back({std::string(channel.key), quantity_form(channel.unit), ""});
  return form;
}

Channel read_channel_key(const TomlNode& table, const std::string& key) {
  const auto channel = channel_from_key(key);
  if (channel) return *channel;
  std::vector<std::string> known;
  for (const ChannelInfo& row : channel_table()) known.emplace_back(row.key);
  table.fail_unknown(key, "channel", known);
}

UnitConversion stated_conversion(const StatedUnit& stated, std::string_view si_unit) {
  if (stated.full_scale > 0.0) return {kFullCommand_v / stated.full_scale, 0.0};
  return unit_conversion(stated.unit, si_unit);
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
    case model::Feedback::three_variable:
      return Channel::reference;
    case model::Feedback::force:
      return Channel::force_reference;
    case model::Feedback::load_pressure:
      return Channel::load_pressure_reference;
    case model::Feedback::angle:
      return Channel::angle_reference;
    case model::Feedback::torque:
      return Channel::torque_reference;
    case model::Feedback::acceleration:
    case model::Feedback::three_variable_acceleration:
      return Channel::acceleration_reference;
  }
  return Channel::reference;
}

Channel motion_channel(const model::Rig& rig) {
  return rig.plant == model::PlantKind::linkage ? Channel::angle : Channel::position;
}

Channel external_load_channel(const model::Rig& rig) {
  return rig.plant == model::PlantKind::linkage ? Channel::torque : Channel::force;
}

}  // namespace rigcal::datasets
