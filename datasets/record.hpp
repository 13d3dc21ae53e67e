#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/describe.hpp"
#include "common/file.hpp"
#include "model/signal/signal.hpp"

namespace rigcal::datasets {

/// Quantity in a column of a record.
enum class Channel {
  reference,                ///< reference of a position loop [m]
  command,                  ///< valve command [V]
  position,                 ///< [m]
  load_pressure,            ///< [Pa]
  pressure_a,               ///< [Pa]
  pressure_b,               ///< [Pa]
  supply_pressure,          ///< [Pa]
  tank_pressure,            ///< [Pa]
  force,                    ///< [N]
  temperature,              ///< [K]
  acceleration,             ///< acceleration of the piston and the mass fixed to it [m/s2]
  payload_acceleration,     ///< acceleration of the second mass [m/s2]
  force_reference,          ///< reference of a force loop [N]
  load_pressure_reference,  ///< reference of a load pressure loop [Pa]
  acceleration_reference,   ///< reference of an acceleration loop [m/s2]
  angle,                    ///< angle of a joint [rad]
  pilot_pressure,           ///< pilot pressure of the spool [Pa]
};

struct ChannelInfo {
  Channel channel;
  std::string_view key;   ///< name in the campaign file and in result files: "position"
  std::string_view name;  ///< with its SI unit: "position_m"
  std::string_view unit;  ///< SI unit: "m"
  bool is_output;         ///< compared with the model unless its role says otherwise
};

/// All channels, in the order of the enumeration.
const std::vector<ChannelInfo>& channel_table();
const ChannelInfo& info(Channel channel);
std::optional<Channel> channel_from_key(std::string_view key);

/// Whether a channel drives the rig: a command, or the reference of a loop.
bool is_drive(Channel channel);

/// Step of time in which samples are missing.
struct TimeHole {
  std::size_t row = 0;  ///< number of the sample after it, from 1
  double from_s = 0.0;
  double to_s = 0.0;
};

/// One recorded run as it came from a file, in SI.
struct Repeat {
  std::string source;  ///< file, and the set of columns if one file has several repeats
  std::vector<double> time_s;
  std::map<Channel, std::vector<double>> values;  ///< each of the shape of time_s
  std::vector<std::string> warnings{};            ///< doubts about its files, in words
  std::vector<TimeHole> holes{};                  ///< holes in the times of its file, increasing
  /// Marks the samples that its file lacks, shape of time_s; empty: none. They are never compared.
  std::vector<bool> bridged{};
};

/// Mean over the repeats of one channel.
struct Series {
  std::vector<double> mean;  ///< shape (samples)
  /// Sample standard deviation (n - 1) over repeats; NaN at the ends where only one repeat has a
  /// sample; empty for a single repeat.
  std::vector<double> sd;
  std::vector<int> count;  ///< repeats that carry this sample
  /// Standard deviation of one repeat, pooled over the samples: sqrt(mean of sd^2). NaN without
  /// both repeats and the campaign's `sd`.
  double pooled_sd = std::numeric_limits<double>::quiet_NaN();
  /// Standard deviation of the mean, by which residuals are divided. NaN if unknown.
  double sd_of_mean = std::numeric_limits<double>::quiet_NaN();
  int repeats = 1;  ///< repeats that carry this channel
  /// Each repeat minus the mean, NaN without a sample, shape (repeats, samples); empty unless
  /// requested, and for a reference that all repeats share.
  std::vector<std::vector<double>> deviations;
};

/// Result of averaging for one repeat.
struct RepeatReport {
  std::string source;
  double offset_s = 0.0;  ///< delay of this repeat against their mean
  /// rms distance from the mean of the others over the pooled sd; of its worst channel
  double deviation = 0.0;
  bool outlier = false;
  double shifted_s = 0.0;  ///< offset_s if it was subtracted to align the repeat, else 0
  RIGCAL_DESCRIBE(source, offset_s, deviation, outlier)
};

struct TimeWindow {
  double start_s = 0.0;
  double end_s = 0.0;
};

/// The averaged record of one condition, which the model is compared with.
struct Record {
  std::string condition;
  std::vector<double> time_s;  ///< shape (samples), increasing
  std::map<Channel, Series> channels;
  int repeats = 1;
  std::vector<RepeatReport> repeat_reports;
  /// Windows in order: the campaign's, or those found; empty: the whole record.
  std::vector<TimeWindow> windows;
  /// Generated signal that equals its recorded drive.
  std::optional<model::Signal> generated_drive{};
  std::vector<std::string> notes;     ///< in words: changes to the record, such as decimation
  std::vector<std::string> warnings;  ///< in words: outliers, gaps, spikes, sensors
  /// In words: samples missing in the windows, so that nothing can be compared with the record.
  std::vector<std::string> holes;
  std::vector<FileState> files;  ///< every file that was read for it, with its state before reading
};

}  // namespace rigcal::datasets
