#pragma once

#include <limits>
#include <optional>
#include <string>

#include "common/range.hpp"

// The one rule for writing estimates on pages, terminals and in tables.

namespace rigcal::report {

inline constexpr Range kAnywhere{-std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::infinity()};

/// Significant digits of a standard error.
inline constexpr int kErrorDigits = 2;

/// Rounds a value to the last of the two significant digits of its uncertainty (GUM, 7.2.6), with
/// two to seven digits of its own: 85.0114 with 0.051 is "85.011", 66.9 with 500 is "67", 3.8e-13
/// with 1.2e-13 is "3.8e-13". It gets more digits if rounding would take it out of `allowed`. Only
/// zero is "0"; a value that is not finite is "-". Without an uncertainty it has six digits.
///
/// @param uncertainty  half width of its interval, in the unit of the value
/// @param allowed      range of the value, in its unit
std::string matched(double value, double uncertainty, const Range& allowed = kAnywhere);

/// A value and the ends of its interval.
struct EstimateText {
  std::string value, low, high;  ///< both ends are empty if there is no interval
};

/// Writes an estimate with the digits that its interval supports. Rounding takes neither the value
/// out of its interval or bounds, nor an end of the interval out of the bounds.
///
/// @param ci95    in the unit of the value
/// @param bounds  in the unit of the value
EstimateText estimate_text(double value, const std::optional<Range>& ci95,
                           const Range& bounds = kAnywhere);

}  // namespace rigcal::report
