#include "datasets/draft/draft_campaign.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <span>

#include "common/error.hpp"
#include "common/quantity.hpp"
#include "datasets/campaign/keys/campaign_keys.hpp"
#include "datasets/campaign/toml/toml_reader.hpp"
#include "datasets/draft/column_guess.hpp"
#include "datasets/draft/start_motion.hpp"
#include "datasets/prepare/waveform_guess.hpp"
#include "datasets/read/record_reader.hpp"
#include "model/plant/parameter.hpp"

namespace rigcal::datasets {
namespace {

namespace fs = std::filesystem;

/// A text split at the number that ends it: "run_03" into "run_" and "03".
struct Numbered {
  std::string stem;
  std::string number;
};

Numbered split_number(const std::string& text) {
  std::size_t at = text.size();
  while (at > 0 && text[at - 1] >= '0' && text[at - 1] <= '9') --at;
  return {text.substr(0, at), text.substr(at)};
}

std::vector<std::vector<double>> read(const fs::path& file, const std::string& time,
                                      const std::string& column) {
  return record_reader(file).load(file, {{time, column}, time}).columns;
}

// ---- Columns -------------------------------------------------------------------------------

/// Columns of one channel in a file: a single column, or several numbered ones that are repeats.
struct ChannelColumns {
  Channel channel = Channel::position;
  std::string stem;                  ///< name, without its number if there are several columns
  std::vector<std::string> numbers;  ///< empty for a single column
  std::string unit;
};

struct FileColumns {
  std::string time;
  std::string time_unit;
  std::vector<ChannelColumns> channels;
  std::vector<std::string> unknown;
  std::map<std::string, std::string> units;  ///< units of `unknown`, if the file gives them
  /// Unnamed lines of a matrix after its time: rows of an array from Simulink's "To File", or
  /// columns.
  std::vector<std::string> rows;
  std::string lacks;  ///< why the file is not a recording, in words; empty if it is one
};

/// Returns the rows or columns of the first matrix in the file that begins with a time. Simulink's
/// "To File" block with the format "Array" saves such rows; arrays in HDF5 usually have columns.
/// Empty if there is no such matrix.
std::vector<std::string> timed_lines(const fs::path& file,
                                     const std::vector<RecordColumn>& columns) {
  constexpr int kMostTried = 10;
  int tried = 0;
  const auto matrix_of = [](const std::string& name) { return name.substr(0, name.rfind('(')); };
  for (std::size_t i = 0; i < columns.size() && tried < kMostTried; ++i) {
    const std::string& first = columns[i].name;
    if (!columns[i].is_matrix_line || !(first.ends_with("(1,:)") || first.ends_with("(:,1)")))
      continue;
    std::vector<std::string> lines;
    for (std::size_t k = i; k < columns.size() && columns[k].is_matrix_line; ++k) {
      if (matrix_of(columns[k].name) != matrix_of(first)) break;
      lines.push_back(columns[k].name);
    }
    if (lines.size() < 2) continue;
    ++tried;
    try {
      read(file, lines[0], lines[1]);
      return lines;
    } catch (const InputError&) {
      continue;  // its first line is not a time
    }
  }
  return {};
}

std::string names_text(const std::vector<RecordColumn>& columns) {
  constexpr std::size_t kMostNamed = 40;
  std::vector<std::string_view> names;
  for (const RecordColumn& column : columns)
    if (names.size() < kMostNamed) names.push_back(column.name);
  const std::string more = columns.size() > kMostNamed
                               ? fmt::format(" and {} more", columns.size() - kMostNamed)
                               : std::string();
  return fmt::format("{}{}", fmt::join(names, ", "), more);
}

/// Handles a file without a time column. Either a matrix contains the times, or the file is not a
/// recording, and the reason is noted.
void without_time(const fs::path& file, const std::vector<RecordColumn>& columns,
                  FileColumns& found) {
  found.rows = timed_lines(file, columns);
  if (!found.rows.empty()) {
    found.time = found.rows.front();
    const auto time = std::find_if(columns.begin(), columns.end(), [&](const RecordColumn& each) {
      return each.name == found.time;
    });
    found.time_unit = time->unit.empty() ? "s" : time->unit;  // Simulink uses no other unit
    found.rows.erase(found.rows.begin());
    std::erase_if(found.unknown, [&](const std::string& name) {
      return name == found.time ||
             std::find(found.rows.begin(), found.rows.end(), name) != found.rows.end();
    });
    return;
  }
  found.lacks = columns.empty()
                    ? fmt::format("it contains no vector or matrix of numbers; {}",
                                  record_reader(file).if_empty)
                    : fmt::format("no column looks like a time (t, time, ...); the columns are {}",
                                  names_text(columns));
}

FileColumns columns_of(const fs::path& file) {
  const std::vector<RecordColumn> columns = record_reader(file).columns(file);
  std::map<std::string, std::vector<std::string>> numbers;  // numbers by stem
  for (const RecordColumn& column : columns) {
    const Numbered numbered = split_number(column.name);
    if (!numbered.number.empty()) numbers[numbered.stem].push_back(numbered.number);
  }
  FileColumns found;
  for (const RecordColumn& column : columns) {
    const std::string& name = column.name;
    const Numbered numbered = split_number(name);
    const bool several = !numbered.number.empty() && numbers[numbered.stem].size() > 1;
    // "p1" and "p2" are two pressures, not two repeats.
    const bool own_word = guess_column(name).channel && !guess_column(numbered.stem).channel;
    const bool repeated = several && !own_word;
    const std::string shown = repeated ? numbered.stem : name;
    ColumnGuess guess = guess_column(shown);
    if (!column.unit.empty()) guess.unit = column.unit;
    if (column.is_time) guess = {true, {}, guess.unit};
    if (guess.is_time && found.time.empty()) {
      found.time = name;
      found.time_unit = guess.unit;
    } else if (guess.channel) {
      const bool known = std::any_of(found.channels.begin(), found.channels.end(),
                                     [&](const ChannelColumns& c) { return c.stem == shown; });
      if (!known)
        found.channels.push_back({*guess.channel, shown,
                                  repeated ? numbers[numbered.stem] : std::vector<std::string>{},
                                  guess.unit});
    } else {
      found.unknown.push_back(name);
      if (!guess.unit.empty()) found.units[name] = guess.unit;
    }
  }
  if (found.time.empty()) {
    without_time(file, columns, found);
  } else if (found.channels.empty()) {
    found.lacks = fmt::format(
        "no column looks like a channel (reference, command, position, "
        "pressure_a, ...); the columns are {}",
        names_text(columns));
  }
  return found;
}

/// Groups the columns that belong to the same repeats. A new set begins when a channel occurs
/// again.
std::vector<std::vector<ChannelColumns>> column_sets(const FileColumns& columns) {
  std::vector<std::vector<ChannelColumns>> sets;
  for (const ChannelColumns& column : columns.channels) {
    if (column.numbers.empty()) continue;
    const bool again =
        !sets.empty() &&
        (sets.back().front().numbers != column.numbers ||
         std::any_of(sets.back().begin(), sets.back().end(),
                     [&](const ChannelColumns& c) { return c.channel == column.channel; }));
    if (sets.empty() || again) sets.emplace_back();
    sets.back().push_back(column);
  }
  return sets;
}

// ---- Text ----------------------------------------------------------------------------------

std::string comment(const std::string& text) { return "  # " + text; }

/// Returns one line of [recording.channels]. If the dimension of the column differs from that of
/// the channel, the line needs a gain.
/// @param minus  column for the opposite direction; empty if there is none
std::string channel_line(Channel channel, const std::string& column, const std::string& unit,
                         const std::string& minus = {}) {
  const ChannelInfo& about = info(channel);
  std::string shown_unit = unit.empty() ? kBlank : unit;
  std::string remark;
  if (unit.empty()) {
    remark = comment(fmt::format("the unit of the column, such as \"{}\"", about.unit));
  } else {
    try {
      unit_conversion(unit, about.unit);
    } catch (const QuantityError&) {
      shown_unit = kBlank;
      remark = comment(fmt::format(
          "the column is in {0}: a unit such as \"{1}\", with gain = ... in that unit per {0}",
          unit, about.unit));
    }
  }
  std::string name = column.empty() ? "" : fmt::format("column = {}, ", toml_quoted(column));
  if (!minus.empty()) name += fmt::format("minus = {}, ", toml_quoted(minus));
  return fmt::format("{} = {{ {}unit = {} }}{}\n", about.key, name, toml_quoted(shown_unit),
                     remark);
}

const ChannelColumns* find(const FileColumns& columns, Channel channel) {
  const auto found = std::find_if(columns.channels.begin(), columns.channels.end(),
                                  [&](const ChannelColumns& c) { return c.channel == channel; });
  return found == columns.channels.end() ? nullptr : &*found;
}

/// Returns the columns with the motion of the rig: the angle of a joint, or else the position of a
/// piston.
const ChannelColumns* motion_of(const FileColumns& columns) {
  const ChannelColumns* angle = find(columns, Channel::angle);
  return angle != nullptr ? angle : find(columns, Channel::position);
}

/// Returns the controlled quantity of the loop whose reference is recorded; std::nullopt if no
/// reference is recorded.
std::optional<model::Feedback> loop_of(const FileColumns& columns) {
  if (find(columns, Channel::angle) != nullptr) return std::nullopt;  // a joint has no controller
  for (std::size_t i = 0; i < model::kFeedbackCount; ++i) {
    const model::Rig rig{{}, model::ControllerKind::pid, {}, static_cast<model::Feedback>(i)};
    if (find(columns, drive_channel(rig)) != nullptr) return rig.feedback;
  }
  return std::nullopt;
}

/// Whether a pilot pressure drives the rig. A controller would drive it with a voltage instead.
bool has_pilot(const FileColumns& columns) {
  return find(columns, Channel::pilot_pressure) != nullptr && !loop_of(columns);
}

/// Returns the direction in which a drive column moves the machine, according to a word in its
/// name: 1 out or up, -1 in or down, 0 unknown.
int direction_of(const std::string& name) {
  using Words = std::array<std::string_view, 9>;
  constexpr Words kOut{"up", "out", "extend", "raise", "open", "forward", "fwd", "auf", "aus"};
  constexpr Words kIn{"down", "dn", "in", "retract", "close", "reverse", "rev", "ab", "ein"};
  std::string part;
  for (const char c : name + "_") {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      part += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      continue;
    }
    if (std::find(kOut.begin(), kOut.end(), part) != kOut.end()) return 1;
    if (std::find(kIn.begin(), kIn.end(), part) != kIn.end()) return -1;
    part.clear();
  }
  return 0;
}

/// Columns of a drive that has a separate column for each direction.
struct OneEachWay {
  std::string out;
  std::string in;
};

std::optional<OneEachWay> one_each_way(const FileColumns& columns, Channel drive) {
  OneEachWay found;
  for (const ChannelColumns& column : columns.channels) {
    if (column.channel != drive || !column.numbers.empty()) continue;
    const int direction = direction_of(column.stem);
    if (direction > 0 && found.out.empty()) found.out = column.stem;
    if (direction < 0 && found.in.empty()) found.in = column.stem;
  }
  if (found.out.empty() || found.in.empty()) return std::nullopt;
  return found;
}

/// Reads the named columns; those that cannot be read are empty.
std::vector<std::vector<double>> columns_or_none(const fs::path& file,
                                                 const std::vector<std::string>& names) {
  try {
    return record_reader(file).load(file, {names, {}}).columns;
  } catch (const InputError&) {
  }
  std::vector<std::vector<double>> columns(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    try {
      columns[i] = std::move(record_reader(file).load(file, {{names[i]}, {}}).columns.at(0));
    } catch (const InputError&) {
    }
  }
  return columns;
}

/// Describes the range of a column and its possible meaning, in brackets.
std::string range_text(const std::vector<double>& values, const std::string& unit,
                       bool has_position) {
  if (values.empty()) return {};
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const bool increases =
      values.size() > 2 &&
      std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) == values.end();
  const auto channel = guess_by_unit(unit, has_position);
  std::string guess;
  if (channel) guess = fmt::format(", perhaps {}", info(*channel).key);
  if (!channel && increases) guess = ", perhaps time";
  return fmt::format(" ({:.6g} to {:.6g}{}{}{})", *low, *high, unit.empty() ? "" : " ", unit,
                     guess);
}

/// Lists the columns that were not recognised, with their ranges.
std::string unknown_columns_text(const fs::path& file, const FileColumns& columns) {
  constexpr std::size_t kMostShown = 40;
  std::vector<std::string> names = columns.unknown;
  if (names.empty()) return {};
  if (names.size() > kMostShown) names.resize(kMostShown);
  const bool has_position =
      std::any_of(columns.channels.begin(), columns.channels.end(),
                  [](const ChannelColumns& c) { return c.channel == Channel::position; });
  const auto values = columns_or_none(file, names);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto unit = columns.units.find(names[i]);
    names[i] += range_text(values[i], unit == columns.units.end() ? std::string() : unit->second,
                           has_position);
  }
  const std::string more = columns.unknown.size() > names.size()
                               ? fmt::format(" and {} more", columns.unknown.size() - names.size())
                               : std::string();
  return fmt::format("# not used: {}{}\n", fmt::join(names, ", "), more);
}

/// Returns the text for a file in which no channel, or not even a time, is recognised.
std::string blank_channels_text(const fs::path& file, const FileColumns& columns) {
  std::string text = "[recording.channels]\n# No column was recognised: see those below.\n";
  text += columns.time.empty()
              ? fmt::format("time = {{ column = \"{}\", unit = \"s\" }}{}\n", kBlank,
                            comment("one of the columns below"))
              : fmt::format("time = {{ column = {}, unit = {} }}\n", toml_quoted(columns.time),
                            toml_quoted(columns.time_unit.empty() ? "s" : columns.time_unit));
  for (const ChannelColumns& column : columns.channels)
    text += channel_line(column.channel, column.numbers.empty() ? column.stem : "", column.unit);
  if (columns.channels.empty()) {
    text += fmt::format("position = {{ column = \"{0}\", unit = \"{0}\" }}\n", kBlank);
    text += fmt::format("command = {{ column = \"{0}\", unit = \"{0}\" }}{1}\n", kBlank,
                        comment("or reference, in a position loop"));
  }
  return text + unknown_columns_text(file, columns);
}

std::string channels_text(const fs::path& file, const FileColumns& columns) {
  if (!columns.lacks.empty()) return blank_channels_text(file, columns);
  std::string text = "[recording.channels]\n";
  text += fmt::format("time = {{ column = {}, unit = {} }}{}\n", toml_quoted(columns.time),
                      toml_quoted(columns.time_unit.empty() ? "s" : columns.time_unit),
                      columns.time_unit.empty() ? comment("assumed: its name has no unit") : "");
  std::vector<Channel> done;
  for (const ChannelColumns& column : columns.channels) {
    if (column.channel == Channel::pilot_pressure && !has_pilot(columns)) {
      text +=
          fmt::format("# '{}' looks like a pilot pressure, which drives no rig with a controller\n",
                      column.stem);
      continue;
    }
    if (column.channel == Channel::command && has_pilot(columns)) {
      text += fmt::format(
          "# '{}' also looks like a drive: the pilot pressure is nearer to the "
          "spool\n",
          column.stem);
      continue;
    }
    const bool again = std::find(done.begin(), done.end(), column.channel) != done.end();
    if (!again) {
      done.push_back(column.channel);
      const auto ways = one_each_way(columns, column.channel);
      if (ways && (column.channel == Channel::command || column.channel == Channel::pilot_pressure))
        text += channel_line(column.channel, ways->out, column.unit, ways->in);
      else
        text +=
            channel_line(column.channel, column.numbers.empty() ? column.stem : "", column.unit);
    } else if (column.numbers.empty() && !one_each_way(columns, column.channel)) {
      text += fmt::format("# '{}' also looks like {}\n", column.stem, info(column.channel).key);
    }
  }
  return text + unknown_columns_text(file, columns);
}

/// Lists unnamed lines with their ranges, from which the user can identify them.
std::string rows_text(const fs::path& file, const FileColumns& columns) {
  if (columns.rows.empty()) return {};
  std::string text = columns.time.ends_with("(1,:)")
                         ? "# An array of Simulink's \"To File\": time in its first row, and "
                           "nothing names the others.\n"
                           "# Give each channel its row"
                         : "# A matrix with a time in its first column, and nothing names the "
                           "others.\n# Give each channel its column";
  text += " and unit, reference = { ... } too if one drives a controller:\n";
  for (const std::string& row : columns.rows) {
    const auto values = read(file, columns.time, row).at(1);
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    text += fmt::format("# {}: {:.6g} to {:.6g}\n", row, *low, *high);
  }
  return text + fmt::format("position = {{ column = {0}, unit = {0} }}{1}\n", toml_quoted(kBlank),
                            comment(columns.time.ends_with("(1,:)") ? "one of these rows"
                                                                    : "one of these columns"));
}

/// Optional terms that most two-chamber cylinders have.
constexpr std::array<std::string_view, 15> kTwoChamberTerms{
    "retracted_position", "valve_dead_band",    "valve_time_constant", "transport_delay",
    "gain_b_to_tank",     "valve_null_leakage", "laminar_leakage",     "gravity",
    "external_force",     "load_gradient",      "coulomb_friction",    "bristle_stiffness",
    "air_fraction",       "stop_stiffness",     "make_up_conductance"};

/// Optional terms for a servo valve with a symmetric cylinder.
constexpr std::array<std::string_view, 8> kLoadPressureTerms{
    "valve_offset",       "valve_dead_band", "valve_time_constant", "transport_delay",
    "valve_null_leakage", "laminar_leakage", "external_force",      "coulomb_friction"};

/// Optional terms for a joint.
constexpr std::array<std::string_view, 15> kLinkageTerms{
    "reference_angle", "lever_gradient",      "lever_curvature",
    "gravity_moment",  "joint_friction",      "gravity_moment_gradient",
    "stop_stiffness",  "valve_time_constant", "gain_a_to_tank",
    "gain_b_to_tank",  "make_up_conductance", "supply_resistance",
    "supply_capacity", "pump_flow",           "air_fraction"};

/// A rotary actuator in place of cylinder and lever, or the travel of the piston by a triangle or a
/// table in place of the lever.
constexpr std::array<std::string_view, 12> kTravelTerms{"displacement_per_radian",

                                                        "triangle_base",
                                                        "triangle_arm",
                                                        "triangle_angle",
                                                        "travel_table_from",
                                                        "travel_table_to",
                                                        "travel_0",
                                                        "travel_20",
                                                        "travel_40",
                                                        "travel_60",
                                                        "travel_80",
                                                        "travel_100"};

/// Terms for the pump and check valves of a two-chamber cylinder behind a pilot-operated valve.
constexpr std::array<std::string_view, 6> kPumpTerms{"relief_pressure",     "supply_resistance",
                                                     "supply_capacity",     "pump_flow",
                                                     "load_sensing_margin", "compensator_pressure"};

/// Terms for a valve that is driven by a pilot pressure.
constexpr std::array<std::string_view, 6> kPilotTerms{
    "pilot_dead_band",     "pilot_exponent",         "return_exponent",
    "return_line_opening", "return_line_resistance", "bypass_opening"};

/// A load by a table, proposed if position and both chamber pressures were recorded: they show how
/// the load varies with the travel.
constexpr std::array<std::string_view, 8> kLoadTableTerms{
    "load_table_from", "load_table_to", "load_0",  "load_20",
    "load_40",         "load_60",       "load_80", "load_100"};

/// Optional terms for a rig with a payload, proposed if an acceleration was recorded.
constexpr std::array<std::string_view, 3> kPayloadTerms{"payload_mass", "payload_frequency",
                                                        "payload_damping_ratio"};

/// Oil that follows its temperature, proposed if a temperature was recorded.
constexpr std::array<std::string_view, 4> kWarmOilTerms{"reference_temperature", "viscosity_decay",
                                                        "thermal_expansion", "bulk_modulus_decay"};

/// What the recorded channels say about the terms of a rig.
struct RecordedSigns {
  bool payload = false;      ///< an acceleration was recorded
  bool load_table = false;   ///< position and both chamber pressures were recorded
  bool pilot = false;        ///< the drive is a pilot pressure
  bool temperature = false;  ///< a temperature was recorded
};

/// Lists optional terms, as comments.
std::string terms_text(model::PlantKind plant, const RecordedSigns& signs) {
  std::vector<std::string_view> terms(kLoadPressureTerms.begin(), kLoadPressureTerms.end());
  if (plant == model::PlantKind::two_chamber)
    terms.assign(kTwoChamberTerms.begin(), kTwoChamberTerms.end());
  if (plant == model::PlantKind::linkage) {
    terms.assign(kLinkageTerms.begin(), kLinkageTerms.end());
    terms.insert(terms.end(), kTravelTerms.begin(), kTravelTerms.end());
  }
  if (signs.pilot && plant == model::PlantKind::two_chamber) {
    // A dead band in volts does not apply to this valve.
    terms.erase(std::remove(terms.begin(), terms.end(), "valve_dead_band"), terms.end());
    terms.insert(terms.end(), kPumpTerms.begin(), kPumpTerms.end());
  }
  if (signs.pilot) terms.insert(terms.end(), kPilotTerms.begin(), kPilotTerms.end());
  if (signs.load_table) terms.insert(terms.end(), kLoadTableTerms.begin(), kLoadTableTerms.end());
  if (signs.payload) terms.insert(terms.end(), kPayloadTerms.begin(), kPayloadTerms.end());
  if (signs.temperature) terms.insert(terms.end(), kWarmOilTerms.begin(), kWarmOilTerms.end());
  std::string text = "# Terms that are absent unless given (rigcal params lists all):\n";
  for (const std::string_view key : terms) {
    const int row = model::parameter_index(plant, key);
    const model::ParameterSpec& spec = model::parameter_table(plant)[static_cast<std::size_t>(row)];
    text += fmt::format("# {} = {}{}\n", key,
                        spec.unit == "1" ? "..." : fmt::format("\"... {}\"", spec.unit),
                        comment(fmt::format("{}: {}", spec.symbol, spec.meaning)));
  }
  return text;
}

std::string model_text(model::PlantKind plant) {
  switch (plant) {
    case model::PlantKind::load_pressure:
      return "model = \"load_pressure\"  # a symmetric cylinder on one servo-valve\n";
    case model::PlantKind::two_chamber:
      return "model = \"two_chamber\"  # single-rod or double-rod, with both chamber pressures\n";
    case model::PlantKind::linkage:
      return "model = \"linkage\"  # a cylinder that turns an arm; chamber A is the one whose "
             "pressure raises the angle\n";
  }
  return {};
}

/// @param loop  controlled quantity; nullopt if the command was recorded
std::string rig_text(model::PlantKind plant, std::optional<model::Feedback> loop,
                     const RecordedSigns& signs) {
  std::string text = "[rig]\n" + model_text(plant);
  text +=
      "# What no data sheet gives is fitted: { start = ..., lower = ..., upper = ..., fit = "
      "true }\n"
      "[rig.parameters]\n";
  for (const model::ParameterSpec& spec : model::parameter_table(plant)) {
    // A valve with four metering edges has one of two gains, depending on what drives it.
    // A linkage may have a triangle or a table in place of its lever, or a rotary actuator in place
    // of the cylinder.
    const bool needed = spec.key == "lever" || spec.key == "area_a" || spec.key == "area_b" ||
                        (plant != model::PlantKind::load_pressure &&
                         spec.key == std::string_view(signs.pilot ? "pilot_gain" : "valve_gain"));
    if (!needed && (spec.kind != model::ParameterKind::plant || spec.default_value)) continue;
    const std::string blank = spec.unit == "1"
                                  ? toml_quoted(kBlank)
                                  : toml_quoted(fmt::format("{} {}", kBlank, spec.unit));
    text += fmt::format("{} = {}{}\n", spec.key, blank,
                        comment(fmt::format("{}: {}{}", spec.symbol, spec.meaning,
                                            spec.unit == "1" ? " (a plain number)" : "")));
  }
  text += terms_text(plant, signs);
  if (!loop)
    return text + fmt::format(
                      "[rig.controller]\ntype = \"none\"  # the recorded {} drives the "
                      "valve\n",
                      signs.pilot ? "pilot pressure" : "command");
  const model::FeedbackRow& row = model::gain_keys(*loop);
  const auto unit_of = [&](std::string_view key) {
    return model::parameter_table(
               plant)[static_cast<std::size_t>(model::parameter_index(plant, key))]
        .unit;
  };
  text += "[rig.controller]\ntype = \"pid\"\n";
  if (*loop != model::Feedback::position)
    text += fmt::format("feedback = \"{}\"{}\n", row.name,
                        comment("what the loop controls; position unless given"));
  text += fmt::format("{} = \"{} {}\"{}\n", row.kp, kBlank, unit_of(row.kp),
                      comment("proportional gain; output_limit, sample_time if there are any"));
  text += fmt::format("# {} = \"... {}\"{}\n", row.ki, unit_of(row.ki),
                      comment(fmt::format("integral gain: without it a model lags where the "
                                          "machine does not; {} likewise",
                                          row.kd)));
  const bool acceleration = *loop == model::Feedback::acceleration;
  if (!signs.payload || !(acceleration || *loop == model::Feedback::position)) return text;
  const auto& table = model::gain_keys(acceleration ? model::Feedback::three_variable_acceleration
                                                    : model::Feedback::three_variable);
  return text + fmt::format("# feedback = \"{}\"{}\n", table.name,
                            comment(fmt::format("the controller of many shake tables: with {}, {}, "
                                                "{}, reference_frequency, reference_damping_ratio",
                                                table.kp, table.kd, table.acceleration)));
}

std::string relative_text(const fs::path& file, const fs::path& folder) {
  const fs::path absolute = fs::weakly_canonical(fs::absolute(file));
  const fs::path relative = absolute.lexically_relative(fs::weakly_canonical(fs::absolute(folder)));
  return toml_quoted((relative.empty() ? absolute : relative).generic_string());
}

std::string numbers_text(const std::vector<std::string>& numbers) {
  bool consecutive = true;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const bool same_width = numbers[i].size() == numbers[0].size();
    consecutive = consecutive && same_width && numbers[0].size() < 9 &&
                  std::stol(numbers[i]) == std::stol(numbers[0]) + static_cast<long>(i);
  }
  if (consecutive) return toml_quoted(numbers.front() + ".." + numbers.back());
  std::vector<std::string> quoted;
  for (const std::string& number : numbers) quoted.push_back(toml_quoted(number));
  return fmt::format("[{}]", fmt::join(quoted, ", "));
}

/// A file and its columns.
struct Recording {
  fs::path file;
  FileColumns columns;
};

/// Files of one condition, whose names differ only in their last number.
struct FileGroup {
  std::string id;
  std::vector<Recording> files;
};

std::string repeats_text(const std::vector<Recording>& files, const FileColumns& columns,
                         const fs::path& folder) {
  std::vector<std::string> entries;
  for (const auto& [file, own] : files) {
    const auto sets = column_sets(columns);
    if (sets.empty()) entries.push_back(relative_text(file, folder));
    for (const auto& set : sets) {
      std::vector<std::string> named;
      for (const ChannelColumns& column : set)
        named.push_back(
            fmt::format("{} = {}", info(column.channel).key, toml_quoted(column.stem + "{n}")));
      entries.push_back(fmt::format("{{ file = {}, n = {}, columns = {{ {} }} }}",
                                    relative_text(file, folder), numbers_text(set.front().numbers),
                                    fmt::join(named, ", ")));
    }
  }
  return fmt::format("repeats = [ {} ]\n", fmt::join(entries, ",\n            "));
}

// ---- Conditions ----------------------------------------------------------------------------

std::string id_of(const std::string& stem) {
  std::string id;
  for (const char c : stem) {
    const bool allowed = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                         (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-';
    id += allowed ? c : '_';
  }
  while (!id.empty() && (id.back() == '_' || id.back() == '-' || id.back() == '.')) id.pop_back();
  return id.empty() ? "record" : id;
}

/// Proposes limits, as comments, for the compared channels other than the motion.
std::string limits_of_others(const FileColumns& columns) {
  std::string text;
  for (const Channel channel : {Channel::load_pressure, Channel::pressure_a, Channel::pressure_b}) {
    if (find(columns, channel) == nullptr || motion_of(columns) == nullptr) continue;
    const auto key = info(channel).key;
    text += fmt::format(
        "# [acceptance.{0}]\n# rho2 = 0.95  # or, in [acceptance]: not_judged = [\"{0}\"]\n", key);
  }
  return text;
}

/// Returns the columns with the drive of the rig, or null if it was not recorded.
const ChannelColumns* drive_of(const FileColumns& columns) {
  const auto loop = loop_of(columns);
  if (!loop) return find(columns, has_pilot(columns) ? Channel::pilot_pressure : Channel::command);
  return find(columns, drive_channel(model::Rig{{}, model::ControllerKind::pid, {}, *loop}));
}

/// Reads the time and a channel from a file. If the channel has several columns, only the first is
/// read.
/// @return  nullopt if there is no time, or if its unit is not a unit of time
std::optional<std::pair<std::vector<double>, std::vector<double>>> signal_of(
    const fs::path& file, const FileColumns& columns, const ChannelColumns& channel) {
  if (columns.time.empty()) return std::nullopt;
  const std::string column =
      channel.numbers.empty() ? channel.stem : channel.stem + channel.numbers.front();
  auto data = read(file, columns.time, column);
  try {
    const double to_s =
        unit_conversion(columns.time_unit.empty() ? "s" : columns.time_unit, "s").scale;
    for (double& t : data[0]) t *= to_s;
  } catch (const QuantityError&) {
    return std::nullopt;
  }
  return std::pair{std::move(data[0]), std::move(data[1])};
}

/// Describes the initial state of the runs. It is taken from the record unless a run begins in
/// motion.
std::string initial_text(const std::vector<FileGroup>& groups) {
  const double window_s = Campaign().initial_window_s;
  for (const FileGroup& group : groups) {
    const FileColumns& columns = group.files.front().columns;
    const ChannelColumns* motion = motion_of(columns);
    if (motion == nullptr) continue;
    const auto signal = signal_of(group.files.front().file, columns, *motion);
    if (!signal || !motion_at_start(signal->first, signal->second, window_s)) continue;
    return fmt::format(
        "initial = \"fit\"  # estimated: {} moves within its first {:g} s; \"record\": their mean, "
        "\"rest\": from zero\n",
        group.id, window_s);
  }
  return fmt::format(
      "initial = \"record\"  # the mean of the first {:g} s; \"rest\": from zero; \"fit\": "
      "estimate "
      "it\n",
      window_s);
}

std::string waveform_text(const fs::path& file, const FileColumns& columns) {
  const ChannelColumns* drive = drive_of(columns);
  if (drive == nullptr)
    return fmt::format(
        "waveform = \"{}\"{}\n", kBlank,
        comment("sine or square, with frequency and amplitude: neither reference nor "
                "command was recorded"));
  const auto signal = signal_of(file, columns, *drive);
  if (!signal)
    return fmt::format(
        "waveform = \"recorded\"{}\n",
        comment(columns.time.empty() ? "its time is not known" : "its time has no unit of time"));
  const auto& [time_s, values] = *signal;
  const double rate_hz =
      time_s.size() < 2 ? 0.0
                        : static_cast<double>(time_s.size() - 1) / (time_s.back() - time_s.front());
  const WaveformGuess guess = guess_waveform(time_s, values);
  const bool periodic = is_periodic(guess.waveform);
  std::string text =
      fmt::format("# {}: {}; {} samples at {:.6g} Hz, {:.6g} s\n", info(drive->channel).key,
                  guess.description, time_s.size(), rate_hz, time_s.back() - time_s.front());
  text += fmt::format(
      "waveform = \"{}\"{}\n",
      to_string(periodic && guess.can_be_generated ? guess.waveform : Waveform::recorded),
      periodic && !guess.can_be_generated ? comment("not generated: it has an offset or a phase")
                                          : "");
  if (!guess.frequency_hz || !guess.amplitude) return text;
  text += fmt::format("frequency = \"{:.4g} Hz\"\n", *guess.frequency_hz);
  const std::string_view wanted = info(drive->channel).unit;
  std::string unit = drive->unit.empty() ? kBlank : drive->unit;
  try {
    if (!drive->unit.empty()) unit_conversion(drive->unit, wanted);
  } catch (const QuantityError&) {
    unit = kBlank;
  }
  const bool known = unit != kBlank;
  return text +
         fmt::format("amplitude = \"{:.4g} {}\"{}\n", *guess.amplitude, unit,
                     known ? "" : comment("half of peak to peak, after the gain, with unit"));
}

constexpr std::size_t kFewestOfARecording = 8;  // samples

/// Whether a file has columns of numbers, whatever they are called.
bool has_numbers(const fs::path& file) {
  constexpr std::size_t kMostTried = 40;
  std::vector<std::string> names;
  for (const RecordColumn& column : record_reader(file).columns(file))
    if (names.size() < kMostTried) names.push_back(column.name);
  const auto columns = columns_or_none(file, names);
  return std::count_if(columns.begin(), columns.end(), [](const auto& values) {
           return values.size() >= kFewestOfARecording;
         }) >= 2;
}

/// Separates recordings from other files. A file without a time or a channel, such as a summary
/// stored with the recordings, is listed in `left_out`. If no file has both, files with numbers
/// count as recordings.
/// @throws InputError  if no file is a recording
std::vector<Recording> recordings_among(const std::vector<fs::path>& files,
                                        std::vector<std::string>& left_out) {
  std::vector<Recording> all;
  std::vector<Recording> others;
  for (const fs::path& file : files) {
    Recording recording{file, columns_of(file)};
    (recording.columns.lacks.empty() ? all : others).push_back(std::move(recording));
  }
  const bool any = !all.empty();
  for (Recording& other : others) {
    if (!any && has_numbers(other.file)) {
      all.push_back(std::move(other));
    } else {
      left_out.push_back(
          fmt::format("{} ({})", other.file.filename().string(), other.columns.lacks));
    }
  }
  if (all.empty()) throw InputError({files.at(0).string()}, others.at(0).columns.lacks);
  return all;
}

std::vector<FileGroup> groups_of(std::vector<Recording> recordings) {
  std::vector<std::pair<std::pair<fs::path, std::string>, FileGroup>> groups;
  for (Recording& recording : recordings) {
    const fs::path& file = recording.file;
    const std::string stem = split_number(file.stem().string()).stem;
    const std::pair key{file.parent_path(), stem + file.extension().string()};
    auto found = std::find_if(groups.begin(), groups.end(),
                              [&](const auto& group) { return group.first == key; });
    if (found == groups.end()) found = groups.insert(groups.end(), {key, {id_of(stem), {}}});
    found->second.files.push_back(std::move(recording));
  }
  std::vector<FileGroup> result;
  std::vector<std::string> ids;
  for (auto& [key, group] : groups) {
    if (group.files.size() == 1) group.id = id_of(group.files[0].file.stem().string());
    const auto same = std::count(ids.begin(), ids.end(), group.id);
    ids.push_back(group.id);
    if (same > 0) group.id += fmt::format("-{}", same + 1);
    result.push_back(group);
  }
  return result;
}

/// Reads the data for a draft: the time and drive from the first file of each group. A file that
/// cannot be read, for example because the time restarts with each of several runs, is listed in
/// `left_out`, and the next file in its group is used.
/// @throws InputError  if no group remains; it is the error of the first file that cannot be read
std::vector<FileGroup> readable_among(std::vector<FileGroup> groups,
                                      std::vector<std::string>& left_out) {
  std::optional<InputError> first;
  const auto reads = [&](const Recording& recording) {
    const auto& [file, columns] = recording;
    if (!columns.lacks.empty()) return true;  // has_numbers() has already read it
    const ChannelColumns* drive = drive_of(columns);
    ChannelColumns any;
    if (drive != nullptr) {
      any = *drive;
    } else if (!columns.channels.empty()) {
      any = columns.channels.front();
    } else {
      any.stem = columns.rows.front();
    }
    try {
      signal_of(file, columns, any);
    } catch (const InputError& error) {
      if (!first) first = error;
      left_out.push_back(file.filename().string() +
                         std::string(error.what()).substr(error.where().file.size()));
      return false;
    }
    return true;
  };
  for (FileGroup& group : groups)
    while (!group.files.empty() && !reads(group.files.front()))
      group.files.erase(group.files.begin());
  groups.erase(std::remove_if(groups.begin(), groups.end(),
                              [](const FileGroup& group) { return group.files.empty(); }),
               groups.end());
  if (groups.empty()) throw *first;
  return groups;
}

}  // namespace

Draft draft_campaign(const std::vector<fs::path>& files, const fs::path& folder) {
  std::vector<std::string> left_out;
  const auto groups = readable_among(groups_of(recordings_among(files, left_out)), left_out);
  const auto& [first, columns] = groups.at(0).files.at(0);
  // The unnamed rows may include a reference, so a position loop is assumed.
  auto loop = loop_of(columns);
  if (!loop && !columns.rows.empty()) loop = model::Feedback::position;
  const bool chambers = std::any_of(groups.begin(), groups.end(), [](const FileGroup& group) {
    const FileColumns& own = group.files.front().columns;
    return find(own, Channel::pressure_a) != nullptr || find(own, Channel::pressure_b) != nullptr;
  });
  std::string text = fmt::format(
      "#:schema ./{}\n"
      "# Draft by rigcal init. Replace every \"{}\", delete what does not apply, then run\n"
      "# rigcal check on this file. docs/campaign-file.md explains every key.\n"
      "schema = \"rigcal.campaign/1\"\nname = \"New rig\"\n\n",
      kSchemaFile, kBlank);
  for (const std::string& file : left_out) text += fmt::format("# left out: {}\n", file);
  if (!left_out.empty()) text += "\n";
  auto plant = chambers || has_pilot(columns) ? model::PlantKind::two_chamber
                                              : model::PlantKind::load_pressure;
  if (find(columns, Channel::angle) != nullptr) plant = model::PlantKind::linkage;
  const bool slides = plant != model::PlantKind::linkage;
  const auto recorded = [&own = columns](Channel channel) { return find(own, channel) != nullptr; };
  text += rig_text(plant, loop,
                   {slides && recorded(Channel::acceleration),
                    slides && recorded(Channel::position) && recorded(Channel::pressure_a) &&
                        recorded(Channel::pressure_b),
                    has_pilot(columns), recorded(Channel::temperature)});
  text += "\n[recording]\n" + initial_text(groups);
  text += "# " + draft_line("recording", "before");
  text += "# " + draft_line("recording", "decimate_to");
  text += channels_text(first, columns) + rows_text(first, columns);
  text += "\n[averaging]\n" + draft_line("averaging", "align") +
          "\n# [acceptance]  # what PASS means\n# rho2 = 0.99\n# absolute_error_percent = 1.0\n# " +
          draft_line("acceptance", "decision") + limits_of_others(columns);
  for (const FileGroup& group : groups) {
    const FileColumns& own = group.files.front().columns;
    text += fmt::format("\n[[condition]]\nid = {}\n", toml_quoted(group.id));
    text += waveform_text(group.files.front().file, own);
    text += draft_line("condition", "use") + "# " + draft_line("condition", "leak_level");
    text += repeats_text(group.files, own, folder);
  }
  return {text, left_out};
}

}  // namespace rigcal::datasets
