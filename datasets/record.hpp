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

/// Quantity that a column of a record contains.
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
  base_acceleration,        ///< acceleration of the cylinder's base [m/s2]
  angle_reference,          ///< reference of a loop on the angle of a joint [rad]
  torque,                   ///< moment that the actuator transmits to a joint [N m]
  torque_reference,         ///< reference of a loop on that moment [N m]
};

struct ChannelInfo {
  Channel channel;
  std::string_view key;   ///< name in the campaign file and in result files: "position"
  std::string_view name;  ///< with its SI unit: "position_m"
  std::string_view unit;  ///< SI unit: "m"
  bool is_output;         ///< compared with the model unless its role says otherwise
};

/// Returns all channels, in the order of the enumeration.
const std::vector<ChannelInfo>& channel_table();
const ChannelInfo& info(Channel channel);
std::optional<Channel> channel_from_key(std::string_view key);

/// Whether a channel drives the rig, as a command or the reference of a loop does.
bool is_drive(Channel channel);

/// A gap in the sample times.
struct TimeHole {
  std::size_t row = 0;  ///< number of the first sample after the gap, counted from 1
  double from_s = 0.0;
  double to_s = 0.0;
};

/// One recorded run as read from its file, in SI units.
struct Repeat {
  std::string source;  ///< file, and the set of columns if one file has several repeats
  std::vector<double> time_s;
  std::map<Channel, std::vector<double>> values;  ///< each with the shape of time_s
  std::vector<std::string> warnings{};            ///< doubts about its files, in words
  std::vector<TimeHole> holes{};  ///< gaps in the times of its file, in increasing order
  /// Marks samples that are missing from the file, shape of time_s; empty if none are. They are
  /// never compared with the model.
  std::vector<bool> bridged{};
};

/// One channel, averaged over its repeats.
struct Series {
  std::vector<double> mean;  ///< shape (samples)
  /// Sample standard deviation (n - 1) over the repeats. NaN at the ends where only one repeat has
  /// a sample; empty for a single repeat.
  std::vector<double> sd;
  std::vector<int> count;  ///< number of repeats that have this sample
  /// Standard deviation of one repeat, pooled over the samples: sqrt(mean of sd^2). NaN if there is
  /// only one repeat and the campaign states no `sd`.
  double pooled_sd = std::numeric_limits<double>::quiet_NaN();
  /// Standard deviation of the mean, by which residuals are divided. NaN if unknown.
  double sd_of_mean = std::numeric_limits<double>::quiet_NaN();
  int repeats = 1;  ///< number of repeats that have this channel
  /// Each repeat minus the mean, shape (repeats, samples); NaN where a repeat has no sample. Empty
  /// unless requested, and for a reference that all repeats share.
  std::vector<std::vector<double>> deviations;
};

/// Timing of one repeat, and how well it agrees with the others.
struct RepeatReport {
  std::string source;     ///< file of the repeat
  double offset_s = 0.0;  ///< delay of this repeat relative to the mean delay
  /// rms distance from the mean of the other repeats, divided by the pooled sd; for the worst
  /// channel
  double deviation = 0.0;
  bool outlier = false;    ///< whether the repeat is too far from the others
  double shifted_s = 0.0;  ///< offset_s if it was subtracted to align the repeat, else 0
  double shift = 0.0;      ///< sample i of the first repeat is at i + shift of this one
  RIGCAL_DESCRIBE(source, offset_s, deviation, outlier)
};

struct TimeWindow {
  double start_s = 0.0;
  double end_s = 0.0;
};

/// The averaged record of one condition, for comparison with the model.
struct Record {
  std::string condition;
  std::vector<double> time_s;  ///< shape (samples), increasing
  std::map<Channel, Series> channels;
  int repeats = 1;
  std::vector<RepeatReport> repeat_reports;
  /// Windows in order, from the campaign or found in the record. Empty: the whole record.
  std::vector<TimeWindow> windows;
  /// Generated signal that equals the recorded drive.
  std::optional<model::Signal> generated_drive{};
  std::vector<std::string> notes;     ///< in words: changes to the record, such as decimation
  std::vector<std::string> warnings;  ///< in words: outliers, gaps, spikes, sensors
  /// In words: samples missing within the windows, which rule out any comparison with the record.
  std::vector<std::string> holes;
  std::vector<FileState> files;  ///< every file read for this record, with its state before reading
};

}  // namespace rigcal::datasets
