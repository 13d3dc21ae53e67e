#pragma once

#include <optional>
#include <string_view>

namespace rigcal::datasets {

/// A point in time without a time zone. Its date may have two readings: 01/02/2024 is the first of
/// February, or the second of January.
struct TimeStamp {
  /// Number of the day, with the day of the month before the month; 0 where the text gives a time
  /// of day alone; std::nullopt if that is no date.
  std::optional<long> day_first;
  std::optional<long> month_first;  ///< the same, with the month before the day
  double time_s = 0;                ///< since midnight [s]
  bool has_date = false;

  bool operator==(const TimeStamp&) const = default;
};

/// Reads a time stamp of ISO 8601 ("2024-03-01T12:00:00.005", with a blank too), one with the date
/// as "1.3.2024", "3/1/2024", "01-03-24" or "01-Mar-2024", or a time of day alone ("12:00:00.005",
/// "9:00:00 PM"). A year of two digits is in this century. A zone ("Z", "+01:00") is accepted and
/// ignored, since all stamps of a file share it. Returns std::nullopt for any other text.
std::optional<TimeStamp> time_stamp(std::string_view text);

/// Whether a text is a date alone, as in a column beside the time of day.
bool is_date(std::string_view text);

}  // namespace rigcal::datasets
