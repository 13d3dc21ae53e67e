#pragma once

#include <optional>
#include <string>

namespace rigcal {

/// Returns the days from 1970-01-01 to a date such as "2026-03-01"; nullopt if the text is not a
/// date.
std::optional<int> day_of(const std::string& date);

/// Returns the date, such as "2026-03-01", for a time in days since 1970-01-01.
std::string date_of(double day);

}  // namespace rigcal
