#include "datasets/read/csv/time_stamp.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <string>
#include <system_error>

#include "common/parse_double.hpp"

namespace rigcal::datasets {
namespace {

/// Reads a number of exactly `digits` digits from the beginning of a text, and removes it.
std::optional<int> taken_number(std::string_view& text, std::size_t digits) {
  if (text.size() < digits) return std::nullopt;
  int value = 0;
  for (std::size_t i = 0; i < digits; ++i) {
    if (text[i] < '0' || text[i] > '9') return std::nullopt;
    value = 10 * value + (text[i] - '0');
  }
  text.remove_prefix(digits);
  return value;
}

bool take_sign(std::string_view& text, std::string_view signs) {
  if (text.empty() || signs.find(text.front()) == std::string_view::npos) return false;
  text.remove_prefix(1);
  return true;
}

/// Removes the fraction of a second from the beginning of a text.
double taken_fraction(std::string_view& text) {
  if (!text.starts_with('.') && !text.starts_with(',')) return 0.0;
  std::size_t end = 1;
  while (end < text.size() && text[end] >= '0' && text[end] <= '9') ++end;
  std::string number = "0." + std::string(text.substr(1, end - 1)) + "0";
  text.remove_prefix(end);
  double value = 0.0;
  const auto [rest, error] = parse_double(number.data(), number.data() + number.size(), value);
  return error == std::errc{} ? value : 0.0;
}

bool is_figure(char c) { return c >= '0' && c <= '9'; }

/// Reads a number of one or two digits from the beginning of a text, and removes it.
std::optional<int> taken_short_number(std::string_view& text) {
  const bool two = text.size() > 1 && is_figure(text[1]);
  return taken_number(text, two ? 2 : 1);
}

std::optional<long> day_number(int year, int month, int day) {
  const std::chrono::year_month_day date{std::chrono::year{year},
                                         std::chrono::month{static_cast<unsigned>(month)},
                                         std::chrono::day{static_cast<unsigned>(day)}};
  if (!date.ok()) return std::nullopt;
  return std::chrono::sys_days{date}.time_since_epoch().count();
}

/// Reads a year of four or two digits from the beginning of a text, and removes it.
std::optional<int> taken_year(std::string_view& text) {
  constexpr int kCentury = 2000;
  if (const auto year = taken_number(text, 4)) return year;
  const auto year = taken_number(text, 2);
  return year ? std::optional(kCentury + *year) : std::nullopt;
}

/// Reads the name of a month from the beginning of a text, and removes it: "Mar".
std::optional<int> taken_month_name(std::string_view& text) {
  constexpr std::array<std::string_view, 12> kMonths{"jan", "feb", "mar", "apr", "may", "jun",
                                                     "jul", "aug", "sep", "oct", "nov", "dec"};
  std::string name(text.substr(0, 3));
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto found = std::find(kMonths.begin(), kMonths.end(), name);
  if (found == kMonths.end()) return std::nullopt;
  text.remove_prefix(name.size());
  return static_cast<int>(found - kMonths.begin()) + 1;
}

/// Both readings of a date. Only the differences of days matter.
struct Date {
  std::optional<long> day_first;
  std::optional<long> month_first;
};

/// Reads a date from the beginning of a text, and removes it: 2024-03-01, 2024/03/01, 1.3.2024,
/// 3/1/2024, 01-03-24 and 01-Mar-2024.
std::optional<Date> taken_date(std::string_view& text) {
  constexpr std::string_view kSigns = "-/.";
  std::string_view rest = text;
  Date date;
  if (const auto leading = taken_number(rest, 4)) {
    const std::string_view sign = rest.substr(0, 1);
    if (!take_sign(rest, kSigns)) return std::nullopt;
    const auto month = taken_number(rest, 2);
    if (!month || !take_sign(rest, sign)) return std::nullopt;
    const auto day = taken_number(rest, 2);
    if (!day) return std::nullopt;
    date.day_first = date.month_first = day_number(*leading, *month, *day);
  } else {
    const auto first = taken_short_number(rest);
    const std::string_view sign = rest.substr(0, 1);
    if (!first || !take_sign(rest, kSigns)) return std::nullopt;
    const auto name = taken_month_name(rest);
    const auto second = name ? name : taken_short_number(rest);
    if (!second || !take_sign(rest, sign)) return std::nullopt;
    const auto year = taken_year(rest);
    if (!year) return std::nullopt;
    date.day_first = day_number(*year, *second, *first);
    date.month_first = name ? date.day_first : day_number(*year, *first, *second);
  }
  if (!date.day_first && !date.month_first) return std::nullopt;
  text = rest;
  return date;
}

/// Takes "AM" or "PM" off the end of a text. Returns the hours that it adds to midnight or noon;
/// std::nullopt if there is none.
std::optional<int> taken_half_day(std::string_view& text) {
  if (text.size() < 2 || (text.back() != 'M' && text.back() != 'm')) return std::nullopt;
  const char half = text[text.size() - 2];
  const bool morning = half == 'A' || half == 'a';
  if (!morning && half != 'P' && half != 'p') return std::nullopt;
  text.remove_suffix(2);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return morning ? 0 : 12;
}

std::string_view between_quotes(std::string_view text) {
  const bool quoted = text.size() > 1 && text.front() == '"' && text.back() == '"';
  return quoted ? text.substr(1, text.size() - 2) : text;
}

bool is_zone(std::string_view text) {
  if (text.empty() || text == "Z") return true;
  if (!take_sign(text, "+-") || !taken_number(text, 2)) return false;
  take_sign(text, ":");
  return text.empty() || (taken_number(text, 2) && text.empty());
}

}  // namespace

bool is_date(std::string_view text) {
  text = between_quotes(text);
  return taken_date(text) && text.empty();
}

std::optional<TimeStamp> time_stamp(std::string_view text) {
  text = between_quotes(text);
  TimeStamp stamp;
  std::string_view rest = text;
  stamp.day_first = stamp.month_first = 0;
  if (const auto date = taken_date(rest)) {
    if (!take_sign(rest, "T ")) return std::nullopt;
    stamp.day_first = date->day_first;
    stamp.month_first = date->month_first;
    stamp.has_date = true;
    text = rest;
  }
  const auto half_day = taken_half_day(text);
  const auto hour = taken_short_number(text);
  if (!hour || *hour > 23 || !take_sign(text, ":")) return std::nullopt;
  if (half_day && (*hour < 1 || *hour > 12)) return std::nullopt;
  const auto minute = taken_number(text, 2);
  if (!minute || *minute > 59 || !take_sign(text, ":")) return std::nullopt;
  const auto second = taken_number(text, 2);
  if (!second || *second > 60) return std::nullopt;
  const int hours = half_day ? *hour % 12 + *half_day : *hour;
  stamp.time_s = 3600.0 * hours + 60.0 * *minute + *second + taken_fraction(text);
  return is_zone(text) ? std::optional(stamp) : std::nullopt;
}

}  // namespace rigcal::datasets
