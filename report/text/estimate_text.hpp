#pragma once

#include <limits>
#include <optional>
#include <string>

#include "report/json/range.hpp"

// How people read an estimate: the one rule for page, terminal and tables.

namespace rigcal::report {

inline constexpr Range kAnywhere{-std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::infinity()};

/// Significant digits of a standard error.
inline constexpr int kErrorDigits = 2;

/// A value to the last of the two significant digits of its uncertainty (GUM, 7.2.6), but to two
/// digits of its own at least and to seven at most: 85.0114 with 0.051 is "85.011", 66.9 with 500
/// is "67", 3.8e-13 with 1.2e-13 is "3.8e-13". What rounding would take out of `allowed` has more
/// digits. Only zero is "0"; "-" where the value is not finite. Six digits where the uncertainty is
/// not known or zero.
///
/// @param uncertainty  in the unit of the value: half width of its interval
/// @param allowed      range that holds the value, in its unit
std::string matched(double value, double uncertainty, const Range& allowed = kAnywhere);

/// A value and the ends of its interval.
struct EstimateText {
  std::string value, low, high;  ///< both ends empty where there is no interval
};

/// An estimate in the digits that its interval supports; rounding takes neither the value out of
/// its interval or bounds, nor an end of the interval out of the bounds that hold it.
///
/// @param ci95    in the unit of the value
/// @param bounds  likewise
EstimateText estimate_text(double value, const std::optional<Range>& ci95,
                           const Range& bounds = kAnywhere);

}  // namespace rigcal::report
