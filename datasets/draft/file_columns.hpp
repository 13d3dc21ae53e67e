#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "datasets/record.hpp"
#include "model/simulate.hpp"

namespace rigcal::datasets {

/// Unit of the times of controllers on Windows, which campaign files write as "us" with a gain.
inline constexpr std::string_view kTicks = "100 ns";

/// A text split at the number that ends it: "run_03" into "run_" and "03".
struct Numbered {
  std::string stem;
  std::string number;
};
Numbered split_number(const std::string& text);

/// Columns of one channel in a file: a single column, or several numbered ones that are repeats.
struct ChannelColumns {
  Channel channel = Channel::position;
  std::string stem;                  ///< name, without its number if there are several columns
  std::vector<std::string> numbers;  ///< empty for a single column
  std::string unit;
  bool is_external_load = false;  ///< a force or torque that acts on the rig from outside
};

/// A column whose name is not that of a channel.
struct UnknownColumn {
  std::string name;
  std::string unit;   ///< if the file or the name gives it
  std::string other;  ///< what it contains, if that is known: "a velocity"
};

/// Columns of a recording, as `init` understands them.
struct FileColumns {
  std::string time;
  std::string time_unit;
  std::vector<ChannelColumns> channels;
  std::vector<UnknownColumn> unknown;
  /// Names that several columns have, so that none of these can be read.
  std::vector<std::string> ambiguous;
  /// Unnamed lines of a matrix after its time: rows of an array from Simulink's "To File", or
  /// columns.
  std::vector<std::string> rows;
  std::string lacks;  ///< why the file is not a recording, in words; empty if it is one
};

/// Looks at the columns of a file, of which it reads no numbers unless no column is named a time.
/// @throws InputError  if the file cannot be read
FileColumns file_columns(const std::filesystem::path& file);

/// Moves channels with a number in less than half of the rows to the unknown columns: they are
/// sampled more slowly, or have a time of their own.
void set_sparse_aside(const std::filesystem::path& file, FileColumns& columns);

/// Groups the columns that belong to the same repeats. A new set begins when a channel occurs
/// again.
std::vector<std::vector<ChannelColumns>> column_sets(const FileColumns& columns);

/// Returns the first columns of a channel, or null.
const ChannelColumns* column_of(const FileColumns& columns, Channel channel);

/// Whether the rig turns an arm: its angle is recorded, or a torque together with the reference of
/// a torque.
bool turns(const FileColumns& columns);

/// Returns the columns with the motion of the rig: the angle of a joint, or else the position of a
/// piston. Null if there are none.
const ChannelColumns* motion_of(const FileColumns& columns);

/// Returns the columns with the drive of the rig, or null if it was not recorded.
const ChannelColumns* drive_of(const FileColumns& columns);

/// Returns the controlled quantity of the loop whose reference is recorded; std::nullopt if no
/// reference is recorded.
std::optional<model::Feedback> loop_of(const FileColumns& columns);

/// Whether a pilot pressure drives the rig. A controller would drive it with a voltage instead.
bool has_pilot(const FileColumns& columns);

/// Describes what keeps a campaign from reading the channels of a file, such as rows that lack a
/// number. Empty if nothing does.
std::string unreadable_rows(const std::filesystem::path& file, const FileColumns& columns);

/// Reads the named columns; those that cannot be read are empty.
std::vector<std::vector<double>> columns_or_none(const std::filesystem::path& file,
                                                 const std::vector<std::string>& names);

/// Reads two columns, of which the first is a time.
/// @throws InputError  if they cannot be read
std::vector<std::vector<double>> timed_columns(const std::filesystem::path& file,
                                               const std::string& time, const std::string& column);

/// Reads the time and a channel from a file. If the channel has several columns, only the first is
/// read.
/// @return  nullopt if there is no time, or if its unit is not a unit of time
/// @throws InputError  if they cannot be read
std::optional<std::pair<std::vector<double>, std::vector<double>>> signal_of(
    const std::filesystem::path& file, const FileColumns& columns, const ChannelColumns& channel);

}  // namespace rigcal::datasets
