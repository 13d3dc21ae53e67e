#include "common/significant.hpp"

#include <fmt/format.h>

#include <cmath>

namespace rigcal {

std::string significant(double value, int digits) {
  constexpr double kExponentFrom = 1e6;
  std::string text = fmt::format("{:.{}g}", value, digits);
  const double size = std::abs(value);
  if (text.find('e') == std::string::npos || !(size >= 1.0)) return text;
  // The text has an exponent because the value has more digits before the point than requested.
  const double step = std::pow(10.0, std::floor(std::log10(size)) + 1.0 - digits);
  const double rounded = std::round(value / step) * step;
  return std::abs(rounded) < kExponentFrom ? fmt::format("{:.0f}", rounded) : text;
}

}  // namespace rigcal
