#pragma once

#include <optional>
#include <string>

namespace rigcal {

/// Days since 1970-01-01 of "2026-03-01"; empty if it is no date.
std::optional<int> day_of(const std::string& date);

/// "2026-03-01" of the day that a time in days since 1970-01-01 falls on.
std::string date_of(double day);

}  // namespace rigcal
