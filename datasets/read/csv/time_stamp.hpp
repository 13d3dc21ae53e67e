#pragma once

#include <optional>
#include <string_view>

namespace rigcal::datasets {

/// A point in time without a time zone.
struct TimeStamp {
  long day = 0;       ///< number of the day; 0 where the text gives a time of day alone
  double time_s = 0;  ///< since midnight [s]
};

/// Reads a time stamp of ISO 8601 ("2024-03-01T12:00:00.005", with a blank too), one with the date
/// as "1.3.2024" or "3/1/2024", or a time of day alone ("12:00:00.005", "9:00:00 PM"). A zone ("Z",
/// "+01:00") is accepted and ignored, since all stamps of a file share it. Returns std::nullopt for
/// any other text.
std::optional<TimeStamp> time_stamp(std::string_view text);

/// Whether a text is a date alone, as in a column beside the time of day.
bool is_date(std::string_view text);

}  // namespace rigcal::datasets
