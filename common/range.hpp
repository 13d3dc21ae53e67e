#pragma once

#include <cmath>
#include <optional>

namespace rigcal {

/// An interval. In results, it is an array of two numbers.
struct Range {
  double low = 0.0;
  double high = 0.0;
  bool operator==(const Range&) const = default;
};

/// Multiplies both ends by `scale`, which is not negative.
constexpr Range operator*(double scale, const Range& range) {
  return {scale * range.low, scale * range.high};
}

/// Returns the range if both ends are finite.
inline std::optional<Range> finite_ends(const std::optional<Range>& range) {
  const bool finite = range && std::isfinite(range->low) && std::isfinite(range->high);
  return finite ? range : std::nullopt;
}

}  // namespace rigcal
