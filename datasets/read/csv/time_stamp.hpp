#pragma once

#include <optional>
#include <string_view>

namespace rigcal::datasets {

/// A point in time without a time zone.
struct TimeStamp {
  long day = 0;       ///< number of the day; 0 where the text gives a time of day alone
  double time_s = 0;  ///< since midnight [s]
};

/// Reads a time stamp of ISO 8601 ("2024-03-01T12:00:00.005", with a blank too) or a time of day
/// ("12:00:00.005"). A zone ("Z", "+01:00") is accepted and ignored, since all stamps of a file
/// share it. Returns std::nullopt for any other text.
std::optional<TimeStamp> time_stamp(std::string_view text);

}  // namespace rigcal::datasets
