#pragma once

#include <limits>
#include <optional>
#include <string>

#include "common/range.hpp"

// Common rule for writing estimates on pages, on terminals and in tables.

namespace rigcal::report {

inline constexpr Range kAnywhere{-std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::infinity()};

/// Number of significant digits in a standard error.
inline constexpr int kErrorDigits = 2;

/// Rounds a value to the decimal place of the second significant digit of its uncertainty (GUM,
/// 7.2.6), but keeps two to seven significant digits: 85.0114 with 0.051 gives "85.011", 66.9 with
/// 500 gives "67", 3.8e-13 with 1.2e-13 gives "3.8×10⁻¹³". Adds digits if rounding would move the
/// value out of `allowed`. Only zero gives "0"; a value that is not finite gives "-". A value
/// without an uncertainty has six digits.
///
/// @param uncertainty  half width of the interval, in the unit of the value
/// @param allowed      allowed range, in the unit of the value
std::string matched(double value, double uncertainty, const Range& allowed = kAnywhere);

/// Writes the half width of an interval with two significant digits, and with the decimals of its
/// value rather than a power of ten: "0.000079" beside "0.571230".
std::string uncertainty_text(double half_width, double value);

/// A value and the ends of its interval.
struct EstimateText {
  std::string value, low, high;  ///< both ends are empty if there is no interval
};

/// Writes an estimate with the digits that its interval supports. Rounding never moves the value
/// out of its interval or bounds, or an end of the interval out of the bounds.
///
/// @param ci95    in the unit of the value
/// @param bounds  in the unit of the value
EstimateText estimate_text(double value, const std::optional<Range>& ci95,
                           const Range& bounds = kAnywhere);

}  // namespace rigcal::report
