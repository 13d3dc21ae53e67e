#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "report/document/document.hpp"
#include "report/json/range.hpp"
#include "report/text/estimate_text.hpp"

// Numbers in the digits that they deserve: the one rule for page and terminal. A number that is
// missing or NaN is a dash.

namespace rigcal::report::doc {

/// A number that may be missing: null, NaN, nothing.
struct Number {
  std::optional<double> value;
  // NOLINTBEGIN(google-explicit-constructor): each is such a number
  Number(double number) : Number(std::optional(number)) {}
  Number(const std::optional<double>& number) : value(number) {
    if (value && std::isnan(*value)) value.reset();
  }
  // NOLINTEND(google-explicit-constructor)
};

/// An interval that may be missing, in whole or at an end.
struct Interval {
  std::optional<Range> ends;  ///< where both are known
  // NOLINTBEGIN(google-explicit-constructor): each is such an interval
  Interval(const std::optional<Range>& range) : ends(range) {
    if (ends && !(std::isfinite(ends->low) && std::isfinite(ends->high))) ends.reset();
  }
  Interval(const Range& range) : Interval(std::optional(range)) {}
  // NOLINTEND(google-explicit-constructor)
  double half_width() const { return 0.5 * (ends->high - ends->low); }
};

/// A number in a unit that others share, which a heading names.
Quantity in_unit(const Number& value_si, double si_per_unit, int digits = 5);
/// A number in the engineering unit that suits it: 0.0508 m is "50.8" with the unit "mm".
Quantity readable(const Number& value_si, std::string_view si_unit, int digits = 5);
/// rho2, R or CCC: "0.9996", "> 0.9999".
Quantity agreement(const Number& value);
/// A score by its metric: as many decimals as tell it from 1; errors in percent to four digits.
Quantity score(std::string_view metric, const Number& value);
/// So many decimals, never "-0.00".
Quantity decimals(const Number& value, int count);

/// An estimate and its interval, as estimate_text() writes them; the ends are dashes where there is
/// no interval.
struct Estimate {
  Quantity value, low, high;
  bool has_interval = false;
  Line interval() const;  ///< "84.96 … 85.06", or a dash
};
/// @param bounds  that hold the value, SI
Estimate estimate(const Number& value_si, const Interval& interval, double si_per_unit,
                  const Range& bounds = kAnywhere);

}  // namespace rigcal::report::doc
