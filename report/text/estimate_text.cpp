#include "report/text/estimate_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "common/significant.hpp"

namespace rigcal::report {
namespace {

constexpr int kLeastDigits = 2;
constexpr int kMostDigits = 7;
constexpr int kUnknownDigits = 6;
/// Numbers whose leading digit is between these powers of ten are written without a power of ten.
constexpr int kWrittenFrom = -4;
constexpr int kWrittenTo = 5;

struct Rounded {
  std::string text;
  double value = 0.0;  ///< what the text says
  double step = 0.0;   ///< place value of the last digit
};

/// Returns the power of ten of the leading digit, corrected for a 0.1 that is stored as
/// 0.0999999999.
int power_of(double value) {
  constexpr double kRounding = 1e-9;
  return static_cast<int>(std::floor(std::log10(std::abs(value)) + kRounding));
}

/// Rounds a value that is not zero to a number of significant digits.
Rounded rounded(double value, int digits) {
  std::string text = fmt::format("{:.{}e}", value, digits - 1);
  double read = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), read);
  const int power = std::stoi(text.substr(text.find('e') + 1));
  const int decimals = digits - 1 - power;
  const double step = std::pow(10.0, -decimals);
  if (power < kWrittenFrom || power > kWrittenTo)
    return {with_power_of_ten(std::move(text)), read, step};
  return {fmt::format("{:.{}f}", read, std::max(decimals, 0)), read, step};
}

bool holds(const Range& allowed, double value) {
  constexpr double kRounded = 1e-12;  // relative error after a change of unit
  return value >= allowed.low - kRounded * std::abs(allowed.low) &&
         value <= allowed.high + kRounded * std::abs(allowed.high);
}

int digits_of(double value, double uncertainty) {
  if (!(uncertainty > 0.0) || !std::isfinite(uncertainty)) return kUnknownDigits;
  return std::clamp(power_of(value) - power_of(uncertainty) + 2, kLeastDigits, kMostDigits);
}

}  // namespace

std::string matched(double value, double uncertainty, const Range& allowed) {
  if (!std::isfinite(value)) return "-";
  if (value == 0.0) return "0";
  Rounded found;
  for (int digits = digits_of(value, uncertainty); digits <= kMostDigits; ++digits) {
    found = rounded(value, digits);
    if (holds(allowed, found.value)) return found.text;
  }
  // No number of digits keeps the rounded value inside the range. Uses the next number inside.
  for (const double side : {-0.5, 0.5}) {
    const double inward = value + side * found.step;
    if (inward == 0.0) continue;
    const Rounded next = rounded(inward, kMostDigits);
    if (holds(allowed, next.value)) return next.text;
  }
  return with_power_of_ten(fmt::format("{}", value));
}

std::string uncertainty_text(double half_width, double value) {
  std::string own = matched(half_width, half_width);
  if (!(half_width > 0.0) || !std::isfinite(half_width) || value == 0.0 || !std::isfinite(value))
    return own;
  const int power = power_of(value);
  const int decimals = kErrorDigits - 1 - power_of(half_width);
  const bool has_decimals_of_value = power >= kWrittenFrom && power <= kWrittenTo &&
                                     decimals >= 0 && power + decimals < kMostDigits;
  return has_decimals_of_value ? fixed(half_width, decimals) : own;
}

EstimateText estimate_text(double value, const std::optional<Range>& ci95, const Range& bounds) {
  if (!ci95) return {matched(value, 0.0, bounds), {}, {}};
  const auto [low, high] = *ci95;
  const double half_width = 0.5 * (high - low);
  const Range within{std::max(bounds.low, std::min(low, value)),
                     std::min(bounds.high, std::max(high, value))};
  const Range below{low < bounds.low ? kAnywhere.low : bounds.low, std::max(low, value)};
  const Range above{std::min(high, value), high > bounds.high ? kAnywhere.high : bounds.high};
  return {matched(value, half_width, within), matched(low, half_width, below),
          matched(high, half_width, above)};
}

}  // namespace rigcal::report
