#include "common/significant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace rigcal {

std::string with_power_of_ten(std::string number) {
  constexpr std::array kRaised{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  const std::size_t mark = number.find('e');
  if (mark == std::string::npos) return number;
  const std::string power = std::to_string(std::stoi(number.substr(mark + 1)));
  number.erase(mark);
  number += "×10";
  for (const char c : power) number += c == '-' ? "⁻" : kRaised[static_cast<std::size_t>(c - '0')];
  return number;
}

std::string significant(double value, int digits) {
  constexpr double kExponentFrom = 1e6;
  std::string text = fmt::format("{:.{}g}", value, digits);
  const double size = std::abs(value);
  if (text.find('e') == std::string::npos || !(size >= 1.0))
    return with_power_of_ten(std::move(text));
  // The text has an exponent because the value has more digits before the point than requested.
  const double step = std::pow(10.0, std::floor(std::log10(size)) + 1.0 - digits);
  const double rounded = std::round(value / step) * step;
  return std::abs(rounded) < kExponentFrom ? fmt::format("{:.0f}", rounded)
                                           : with_power_of_ten(std::move(text));
}

std::string measured(double value, int digits) {
  std::string text = significant(value, digits);
  if (value == 0.0 || !std::isfinite(value)) return text;
  const std::size_t power = std::min(text.find("×"), text.size());
  const std::size_t point = text.find('.');
  const std::size_t first = text.find_first_not_of("-0.");
  auto written = static_cast<int>(power - first);
  if (point < power && point > first) --written;
  if (written >= digits) return text;
  std::string zeros(static_cast<std::size_t>(digits - written), '0');
  text.insert(power, (point < power ? "" : ".") + zeros);
  return text;
}

std::string fixed(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

std::string to_uncertainty(double value, double uncertainty) {
  constexpr double kRounding = 1e-9;  // 0.1 may be stored as 0.0999999999
  const int decimals = 1 - static_cast<int>(std::floor(std::log10(uncertainty) + kRounding));
  if (decimals >= 0) return fixed(value, decimals);
  const double step = std::pow(10.0, -decimals);
  return fixed(std::round(value / step) * step, 0);
}

std::string p_value_text(double p) {
  return p < 1e-4 ? std::string("p < 0.0001") : fmt::format("p = {:.2g}", p);
}

}  // namespace rigcal
