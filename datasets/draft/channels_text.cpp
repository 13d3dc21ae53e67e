#include "datasets/draft/channels_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "common/quantity.hpp"
#include "datasets/campaign/toml/toml_reader.hpp"
#include "datasets/draft/column_guess.hpp"
#include "datasets/draft/draft_comment.hpp"

namespace rigcal::datasets {
namespace {

namespace fs = std::filesystem;

/// Returns one line of [recording.channels]. If the dimension of the column differs from that of
/// the channel, the line needs a gain.
/// @param minus  column for the opposite direction; empty if there is none
/// @param hint   comment on the channel, where its unit needs none
/// @param is_input  whether the draft states that the channel is an input
std::string channel_line(Channel channel, const std::string& column, const std::string& unit,
                         const std::string& minus = {}, const std::string& hint = {},
                         bool is_input = false) {
  const ChannelInfo& about = info(channel);
  std::string shown_unit = unit.empty() ? kBlank : unit;
  std::string remark = hint.empty() ? hint : comment(hint);
  std::string full_scale;
  // A command may be in parts of its range or a current.
  const bool is_share = channel == Channel::command && converts_to(unit, "1");
  const bool is_current = channel == Channel::command && converts_to(unit, "A");
  if (is_share || is_current) {
    if (is_current) {
      full_scale =
          fmt::format(", full_scale = {}", toml_quoted(fmt::format("{} {}", kBlank, unit)));
      remark = comment("the current at which the valve is fully open");
    }
  } else if (unit.empty()) {
    remark = comment(fmt::format("the unit of the column, such as \"{}\"", about.unit));
  } else if (!converts_to(unit, about.unit)) {
    shown_unit = kBlank;
    remark = comment(fmt::format(
        "the column is in {0}: a unit such as \"{1}\", with gain = ... in that unit per {0}", unit,
        about.unit));
  }
  std::string name = column.empty() ? "" : fmt::format("column = {}, ", toml_quoted(column));
  if (!minus.empty()) name += fmt::format("minus = {}, ", toml_quoted(minus));
  return fmt::format("{} = {{ {}unit = {}{}{} }}{}\n", about.key, name, toml_quoted(shown_unit),
                     full_scale, is_input ? ", role = \"input\"" : "", remark);
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

/// Whether a force or torque is the load of the rig. A loop that controls it has it as its own.
bool is_load_input(const ChannelColumns& column, const FileColumns& columns) {
  const auto controlled =
      column.channel == Channel::force ? model::Feedback::force : model::Feedback::torque;
  return column.is_external_load && loop_of(columns) != controlled;
}

/// Says which of both a force or torque may be: what the actuator transmits, or the load. Empty if
/// the loop controls it, and for other channels.
std::string load_hint(const ChannelColumns& column, const FileColumns& columns) {
  const bool is_force = column.channel == Channel::force;
  if (!is_force && column.channel != Channel::torque) return {};
  if (loop_of(columns) == (is_force ? model::Feedback::force : model::Feedback::torque)) return {};
  const std::string_view positive = is_force ? "position" : "angle";
  if (is_load_input(column, columns))
    return fmt::format(
        "the load, against positive {}; role = \"output\" if it is what the actuator transmits",
        positive);
  return fmt::format(
      "what the actuator transmits; role = \"input\" if it is a load against positive {}",
      positive);
}

/// Says why a channel of a slide or of a joint does not suit the rig; empty if it does.
std::string other_motion_text(const ChannelColumns& column, const FileColumns& columns) {
  const Channel channel = column.channel;
  const bool of_joint = channel == Channel::torque || channel == Channel::torque_reference;
  const bool of_slide = channel == Channel::force || channel == Channel::force_reference ||
                        channel == Channel::position || channel == Channel::reference ||
                        channel == Channel::acceleration;
  if (!(turns(columns) ? of_slide : of_joint)) return {};
  return fmt::format("# '{}' looks like {}, but {}\n", in_comment(column.stem), info(channel).key,
                     of_slide ? "the rig turns an arm, so that its motion is an angle"
                              : "no column looks like an angle");
}

/// Returns one line for each recognised channel. A channel occurs once; further columns that look
/// like it are comments.
std::string known_channels_text(const FileColumns& columns) {
  std::string text;
  std::vector<Channel> done;
  for (const ChannelColumns& column : columns.channels) {
    if (column.channel == Channel::pilot_pressure && !has_pilot(columns)) {
      text += fmt::format(
          "# '{}' looks like a pilot pressure, but a rig with a controller has a reference\n",
          in_comment(column.stem));
      continue;
    }
    if (const std::string other = other_motion_text(column, columns); !other.empty()) {
      text += other;
      continue;
    }
    if (column.channel == Channel::command && has_pilot(columns)) {
      text += fmt::format(
          "# '{}' also looks like a drive, but the pilot pressure is closer to the spool\n",
          in_comment(column.stem));
      continue;
    }
    const bool again = std::find(done.begin(), done.end(), column.channel) != done.end();
    if (!again) {
      done.push_back(column.channel);
      const auto ways = one_each_way(columns, column.channel);
      if (ways && (column.channel == Channel::command || column.channel == Channel::pilot_pressure))
        text += channel_line(column.channel, ways->out, column.unit, ways->in);
      else
        text += channel_line(column.channel, column.numbers.empty() ? column.stem : "", column.unit,
                             {}, load_hint(column, columns), is_load_input(column, columns));
    } else if (column.numbers.empty() && !one_each_way(columns, column.channel)) {
      text += fmt::format("# '{}' also looks like {}{}\n", in_comment(column.stem),
                          info(column.channel).key,
                          is_load_input(column, columns) ? ", as the load: role = \"input\"" : "");
    }
  }
  return text;
}

/// A column that no name identifies, with what its numbers say.
struct Candidate {
  UnknownColumn column;
  bool has_numbers = false;
  double low = 0.0;
  double high = 0.0;
  bool increases = false;

  bool is_constant() const { return has_numbers && !(low < high); }
  /// Whether nothing speaks against a channel in one of these units.
  bool may_be(std::span<const std::string_view> units) const {
    if (!has_numbers || is_constant() || increases || !column.other.empty()) return false;
    return column.unit.empty() ||
           std::any_of(units.begin(), units.end(),
                       [this](std::string_view unit) { return converts_to(column.unit, unit); });
  }
  std::string range() const {
    return fmt::format("{:.6g} to {:.6g}{}", low, high,
                       column.unit.empty() ? std::string() : " " + column.unit);
  }
};

constexpr std::size_t kMostCandidates = 40;

/// Reads the columns that were not recognised, up to a limit.
std::vector<Candidate> candidates_in(const fs::path& file, const FileColumns& columns) {
  std::vector<std::string> names;
  for (const UnknownColumn& column : columns.unknown)
    if (names.size() < kMostCandidates) names.push_back(column.name);
  const auto values = columns_or_none(file, names);
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < names.size(); ++i) {
    Candidate candidate{columns.unknown[i]};
    candidate.has_numbers = !values[i].empty();
    if (candidate.has_numbers) {
      const auto [low, high] = std::minmax_element(values[i].begin(), values[i].end());
      candidate.low = *low;
      candidate.high = *high;
      candidate.increases =
          values[i].size() > 2 && std::adjacent_find(values[i].begin(), values[i].end(),
                                                     std::greater_equal<>()) == values[i].end();
    }
    candidates.push_back(std::move(candidate));
  }
  return candidates;
}

/// Returns a comment with the columns that may fill a blank.
template <typename Suits>
std::string perhaps(const std::vector<Candidate>& candidates, Suits suits) {
  constexpr std::size_t kMostNamed = 3;
  std::vector<std::string> named;
  for (const Candidate& each : candidates)
    if (suits(each)) named.push_back(fmt::format("'{}' ({})", each.column.name, each.range()));
  if (named.empty() || named.size() > kMostNamed) return "one of the columns below";
  return fmt::format("perhaps {}", fmt::join(named, " or "));
}

std::string blank_line(std::string_view key, const std::string& remark) {
  return fmt::format("{0} = {{ column = \"{1}\", unit = \"{1}\" }}{2}\n", key, kBlank,
                     comment(remark));
}

/// Returns blanks for the motion and the drive of a rig where they are not recognised, and columns
/// are left that may contain them.
std::string blanks_text(const FileColumns& columns, const std::vector<Candidate>& candidates) {
  constexpr std::array<std::string_view, 3> kMotion{"m", "rad", "V"};
  constexpr std::array<std::string_view, 6> kDrive{"V", "A", "1", "m", "N", "m/s2"};
  const auto moves = [&](const Candidate& each) { return each.may_be(kMotion); };
  const auto drives = [&](const Candidate& each) { return each.may_be(kDrive); };
  const bool any = std::any_of(candidates.begin(), candidates.end(), [](const Candidate& each) {
    return each.has_numbers && !each.is_constant() && each.column.other.empty();
  });
  if (!any && columns.ambiguous.empty() && !columns.channels.empty()) return {};
  std::string text;
  if (motion_of(columns) == nullptr && columns.rows.empty())
    text += turns(columns)
                ? blank_line("angle", perhaps(candidates, moves))
                : blank_line("position", perhaps(candidates, moves) + "; or angle, of a joint");
  if (drive_of(columns) == nullptr && columns.rows.empty())
    text += blank_line("command",
                       perhaps(candidates, drives) + "; or reference, if a controller follows it");
  return text;
}

/// Lists the columns that were not recognised, as lines to complete.
std::string unknown_columns_text(const FileColumns& columns,
                                 const std::vector<Candidate>& candidates) {
  std::vector<Channel> taken;
  for (const ChannelColumns& column : columns.channels) taken.push_back(column.channel);
  // A slide has no angle, and a joint neither a position nor a reference.
  if (column_of(columns, Channel::position) != nullptr) taken.push_back(Channel::angle);
  if (turns(columns)) taken.insert(taken.end(), {Channel::position, Channel::reference});
  std::string text;
  std::vector<std::string> texts;
  for (const Candidate& each : candidates) {
    if (!each.has_numbers) {
      if (!each.column.name.empty()) texts.push_back(each.column.name);
      continue;
    }
    std::string guess = each.column.other;
    const auto channel =
        guess.empty() ? guess_by_unit(each.column.unit, taken) : std::optional<Channel>();
    if (channel) {
      taken.push_back(*channel);
      guess = fmt::format("perhaps {}", info(*channel).key);
    } else if (guess.empty() && each.increases) {
      guess = "perhaps time";
    } else if (guess.empty() && each.is_constant()) {
      guess = "constant";
    }
    text += fmt::format("# {} = {{ column = {}, unit = {} }}{}\n", kBlank,
                        toml_quoted(each.column.name),
                        toml_quoted(each.column.unit.empty() ? kBlank : each.column.unit),
                        comment(each.range() + (guess.empty() ? "" : ", " + guess)));
  }
  if (!text.empty()) text.insert(0, "# Columns that could not be identified by name:\n");
  if (!texts.empty())
    text += in_comment(fmt::format("# not columns of numbers: {}", fmt::join(texts, ", "))) + "\n";
  if (columns.unknown.size() > candidates.size())
    text += fmt::format("# and {} more columns\n", columns.unknown.size() - candidates.size());
  for (const std::string& name : columns.ambiguous)
    text += in_comment(fmt::format("# several columns are named '{}', so none of them can be read: "
                                   "give them different names",
                                   name)) +
            "\n";
  return text;
}

/// Lists unnamed lines with their ranges, from which the user can identify them.
std::string rows_text(const fs::path& file, const FileColumns& columns) {
  if (columns.rows.empty()) return {};
  std::string text = columns.time.ends_with("(1,:)")
                         ? "# An array of Simulink's \"To File\": time in its first row, the other "
                           "rows have no names.\n# Give each channel its row"
                         : "# A matrix with a time in its first column; the other columns have no "
                           "names.\n# Give each channel its column";
  text += " and unit, reference = { ... } too if one drives a controller:\n";
  for (const std::string& row : columns.rows) {
    const auto values = timed_columns(file, columns.time, row).at(1);
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    text += fmt::format("# {}: {:.6g} to {:.6g}\n", in_comment(row), *low, *high);
  }
  if (motion_of(columns) != nullptr) return text;
  return text + fmt::format("position = {{ column = {0}, unit = {0} }}{1}\n", toml_quoted(kBlank),
                            comment(columns.time.ends_with("(1,:)") ? "one of these rows"
                                                                    : "one of these columns"));
}

}  // namespace

std::string channels_text(const fs::path& file, const FileColumns& columns) {
  const auto candidates = candidates_in(file, columns);
  std::string text = "[recording.channels]\n";
  if (columns.time.empty())
    text += fmt::format(
        "time = {{ column = \"{}\", unit = \"s\" }}{}\n", kBlank,
        comment(perhaps(candidates,
                        [](const Candidate& each) { return each.has_numbers && each.increases; }) +
                "; a count of samples needs gain = ..., the seconds from one to the next"));
  else if (columns.time_unit == kTicks)
    text += fmt::format("time = {{ column = {}, unit = \"us\", gain = 0.1 }}{}\n",
                        toml_quoted(columns.time), comment("in ticks of 100 ns"));
  else
    text += fmt::format("time = {{ column = {}, unit = {} }}{}\n", toml_quoted(columns.time),
                        toml_quoted(columns.time_unit.empty() ? "s" : columns.time_unit),
                        columns.time_unit.empty() ? comment("assumed: its name has no unit") : "");
  return text + known_channels_text(columns) + blanks_text(columns, candidates) +
         unknown_columns_text(columns, candidates) + rows_text(file, columns);
}

}  // namespace rigcal::datasets
