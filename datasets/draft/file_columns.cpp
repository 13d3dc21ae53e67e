#include "datasets/draft/file_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "common/error.hpp"
#include "common/quantity.hpp"
#include "datasets/campaign/campaign.hpp"
#include "datasets/draft/column_guess.hpp"
#include "datasets/read/record_reader.hpp"

namespace rigcal::datasets {
namespace {

namespace fs = std::filesystem;

/// Reads columns for a draft. Rows that lack a number are left out.
RecordTable draft_columns(const fs::path& file, std::vector<std::string> names,
                          const std::string& time) {
  RecordRequest request{std::move(names), time};
  request.leaves_out_rows = true;
  return record_reader(file).load(file, request);
}

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
      timed_columns(file, lines[0], lines[1]);
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
    std::erase_if(found.unknown, [&](const UnknownColumn& column) {
      return column.name == found.time ||
             std::find(found.rows.begin(), found.rows.end(), column.name) != found.rows.end();
    });
    return;
  }
  found.lacks = columns.empty()
                    ? fmt::format("it contains no vector or matrix of numbers; {}",
                                  record_reader(file).if_empty)
                    : fmt::format("no column looks like a time (t, time, ...); the columns are {}",
                                  names_text(columns));
}

}  // namespace

Numbered split_number(const std::string& text) {
  std::size_t at = text.size();
  while (at > 0 && text[at - 1] >= '0' && text[at - 1] <= '9') --at;
  return {text.substr(0, at), text.substr(at)};
}

std::vector<std::vector<double>> timed_columns(const fs::path& file, const std::string& time,
                                               const std::string& column) {
  return draft_columns(file, {time, column}, time).columns;
}

FileColumns file_columns(const fs::path& file) {
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
    ColumnGuess guess = guess_column(shown, column.unit);
    if (column.is_time) guess = {true, {}, guess.unit};
    const auto same = std::count_if(columns.begin(), columns.end(),
                                    [&](const RecordColumn& other) { return other.name == name; });
    if (same > 1) {
      if (std::find(found.ambiguous.begin(), found.ambiguous.end(), name) == found.ambiguous.end())
        found.ambiguous.push_back(name);
    } else if (guess.is_time && found.time.empty()) {
      found.time = name;
      found.time_unit = guess.unit;
    } else if (guess.channel) {
      const bool known = std::any_of(found.channels.begin(), found.channels.end(),
                                     [&](const ChannelColumns& c) { return c.stem == shown; });
      if (!known)
        found.channels.push_back({*guess.channel, shown,
                                  repeated ? numbers[numbered.stem] : std::vector<std::string>{},
                                  guess.unit, guess.is_external_load});
    } else {
      found.unknown.push_back({name, guess.unit, std::string(guess.other)});
    }
  }
  // If there is an angle, a "ref" without a unit is its reference.
  if (column_of(found, Channel::angle) != nullptr) {
    for (ChannelColumns& column : found.channels)
      if (column.channel == Channel::reference && column.unit.empty())
        column.channel = Channel::angle_reference;
  }
  if (found.time.empty()) {
    without_time(file, columns, found);
  } else if (found.channels.empty() && found.ambiguous.empty()) {
    found.lacks = fmt::format(
        "no column looks like a channel (reference, command, position, "
        "pressure_a, ...); the columns are {}",
        names_text(columns));
  }
  return found;
}

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

const ChannelColumns* column_of(const FileColumns& columns, Channel channel) {
  const auto found = std::find_if(columns.channels.begin(), columns.channels.end(),
                                  [&](const ChannelColumns& c) { return c.channel == channel; });
  return found == columns.channels.end() ? nullptr : &*found;
}

bool turns(const FileColumns& columns) {
  return column_of(columns, Channel::angle) != nullptr ||
         (column_of(columns, Channel::torque) != nullptr &&
          column_of(columns, Channel::torque_reference) != nullptr);
}

const ChannelColumns* motion_of(const FileColumns& columns) {
  const ChannelColumns* angle = column_of(columns, Channel::angle);
  return angle != nullptr ? angle : column_of(columns, Channel::position);
}

std::optional<model::Feedback> loop_of(const FileColumns& columns) {
  const auto plant = turns(columns) ? model::PlantKind::linkage : model::PlantKind::two_chamber;
  std::optional<model::Feedback> found;
  for (std::size_t i = 0; i < model::kFeedbackCount; ++i) {
    const model::Rig rig{{}, model::ControllerKind::pid, {}, static_cast<model::Feedback>(i)};
    if (!model::has_loop(plant, rig.feedback) || column_of(columns, drive_channel(rig)) == nullptr)
      continue;
    if (model::controls_motion(rig.feedback)) return rig.feedback;
    if (!found) found = rig.feedback;
  }
  return found;
}

bool has_pilot(const FileColumns& columns) {
  return column_of(columns, Channel::pilot_pressure) != nullptr && !loop_of(columns);
}

const ChannelColumns* drive_of(const FileColumns& columns) {
  const auto loop = loop_of(columns);
  if (!loop)
    return column_of(columns, has_pilot(columns) ? Channel::pilot_pressure : Channel::command);
  return column_of(columns, drive_channel(model::Rig{{}, model::ControllerKind::pid, {}, *loop}));
}

std::vector<std::vector<double>> columns_or_none(const fs::path& file,
                                                 const std::vector<std::string>& names) {
  if (names.empty()) return {};
  try {
    return draft_columns(file, names, {}).columns;
  } catch (const InputError&) {
  }
  std::vector<std::vector<double>> columns(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    try {
      columns[i] = std::move(draft_columns(file, {names[i]}, {}).columns.at(0));
    } catch (const InputError&) {
    }
  }
  return columns;
}

std::string unreadable_rows(const fs::path& file, const FileColumns& columns) {
  std::vector<std::string> names;
  if (!columns.time.empty()) names.push_back(columns.time);
  for (const ChannelColumns& column : columns.channels)
    names.push_back(column.numbers.empty() ? column.stem : column.stem + column.numbers.front());
  if (names.empty()) return {};
  try {
    const std::string left_out = draft_columns(file, names, columns.time).left_out;
    return left_out.empty() ? left_out
                            : left_out + "; remove text and other contents that are not numbers";
  } catch (const InputError& error) {
    const std::string message = std::string(error.what()).substr(error.where().file.size() + 1);
    return error.where().line > 0 ? "line " + message : message;
  }
}

void set_sparse_aside(const fs::path& file, FileColumns& columns) {
  if (columns.time.empty() || unreadable_rows(file, columns).empty()) return;
  const auto rows_with = [&file](const std::string& column) {
    return columns_or_none(file, {column}).at(0).size();
  };
  const std::size_t rows = rows_with(columns.time);
  const auto is_sparse = [&](const ChannelColumns& channel) {
    if (!channel.numbers.empty()) return false;
    const std::size_t numbers = rows_with(channel.stem);
    if (numbers == 0 || 2 * numbers >= rows) return false;
    columns.unknown.push_back(
        {channel.stem, channel.unit,
         fmt::format("a number in {} of {} rows: sampled more slowly, or on another time base; "
                     "save it as a separate recording, or leave it out",
                     numbers, rows)});
    return true;
  };
  std::erase_if(columns.channels, is_sparse);
}

std::optional<std::pair<std::vector<double>, std::vector<double>>> signal_of(
    const fs::path& file, const FileColumns& columns, const ChannelColumns& channel) {
  if (columns.time.empty()) return std::nullopt;
  const std::string column =
      channel.numbers.empty() ? channel.stem : channel.stem + channel.numbers.front();
  auto data = timed_columns(file, columns.time, column);
  try {
    const double to_s =
        columns.time_unit == kTicks
            ? 1e-7
            : unit_conversion(columns.time_unit.empty() ? "s" : columns.time_unit, "s").scale;
    for (double& t : data[0]) t *= to_s;
  } catch (const QuantityError&) {
    return std::nullopt;
  }
  return std::pair{std::move(data[0]), std::move(data[1])};
}

}  // namespace rigcal::datasets
