#include "common/calendar.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

namespace rigcal {

std::optional<int> day_of(const std::string& date) {
  int year = 0;
  unsigned month = 0;
  unsigned day = 0;
  if (std::sscanf(date.c_str(), "%d-%u-%u", &year, &month, &day) != 3) return std::nullopt;
  const std::chrono::year_month_day whole{std::chrono::year(year), std::chrono::month(month),
                                          std::chrono::day(day)};
  if (!whole.ok()) return std::nullopt;
  return static_cast<int>(std::chrono::sys_days(whole).time_since_epoch().count());
}

std::string date_of(double day) {
  const std::chrono::days whole(static_cast<int>(std::floor(day)));
  const std::chrono::year_month_day date{std::chrono::sys_days(whole)};
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
}

}  // namespace rigcal
