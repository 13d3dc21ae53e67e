#include "datasets/read/csv/time_stamp.hpp"

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

bool is_zone(std::string_view text) {
  if (text.empty() || text == "Z") return true;
  if (!take_sign(text, "+-") || !taken_number(text, 2)) return false;
  take_sign(text, ":");
  return text.empty() || (taken_number(text, 2) && text.empty());
}

}  // namespace

std::optional<TimeStamp> time_stamp(std::string_view text) {
  if (text.size() > 1 && text.front() == '"' && text.back() == '"')
    text = text.substr(1, text.size() - 2);
  TimeStamp stamp;
  std::string_view rest = text;
  const auto year = taken_number(rest, 4);
  if (year && take_sign(rest, "-/")) {
    const auto month = taken_number(rest, 2);
    if (!month || !take_sign(rest, "-/")) return std::nullopt;
    const auto day = taken_number(rest, 2);
    if (!day || !take_sign(rest, "T ")) return std::nullopt;
    const std::chrono::year_month_day date{std::chrono::year{*year},
                                           std::chrono::month{static_cast<unsigned>(*month)},
                                           std::chrono::day{static_cast<unsigned>(*day)}};
    if (!date.ok()) return std::nullopt;
    stamp.day = std::chrono::sys_days{date}.time_since_epoch().count();
    text = rest;
  }
  const auto hour = taken_number(text, 2);
  if (!hour || *hour > 23 || !take_sign(text, ":")) return std::nullopt;
  const auto minute = taken_number(text, 2);
  if (!minute || *minute > 59 || !take_sign(text, ":")) return std::nullopt;
  const auto second = taken_number(text, 2);
  if (!second || *second > 60) return std::nullopt;
  stamp.time_s = 3600.0 * *hour + 60.0 * *minute + *second + taken_fraction(text);
  return is_zone(text) ? std::optional(stamp) : std::nullopt;
}

}  // namespace rigcal::datasets
