#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "common/range.hpp"
#include "report/document/document.hpp"
#include "report/text/estimate_text.hpp"

// All number formatting for pages and terminals. A missing number or NaN is shown as a dash.

namespace rigcal::report::doc {

/// A number that may be missing: null, NaN or absent.
struct Number {
  std::optional<double> value;
  // NOLINTBEGIN(google-explicit-constructor): these conversions are intended
  Number(double number) : Number(std::optional(number)) {}
  Number(const std::optional<double>& number) : value(number) {
    if (value && std::isnan(*value)) value.reset();
  }
  // NOLINTEND(google-explicit-constructor)
};

/// An interval that may lack one or both ends.
struct Interval {
  std::optional<Range> ends;  ///< absent unless both ends are known
  // NOLINTBEGIN(google-explicit-constructor): these conversions are intended
  Interval(const std::optional<Range>& range) : ends(finite_ends(range)) {}
  Interval(const Range& range) : Interval(std::optional(range)) {}
  // NOLINTEND(google-explicit-constructor)
  double half_width() const { return 0.5 * (ends->high - ends->low); }
};

/// Formats a number in a given unit, for use below a heading that names the unit.
Quantity in_unit(const Number& value_si, double si_per_unit, int digits = 5);
/// Formats a number in a suitable engineering unit: 0.0508 m becomes "50.8" with the unit "mm".
Quantity readable(const Number& value_si, std::string_view si_unit, int digits = 5);
/// Formats rho2, R or CCC: "0.9996", "> 0.9999".
Quantity agreement(const Number& value);
/// Formats a score as metrics::score_text() does.
Quantity score(std::string_view metric, const Number& value,
               const std::optional<double>& limit = {});
/// Formats a number with `count` decimals, never as "-0.00".
Quantity decimals(const Number& value, int count);

/// An estimate and its interval, formatted by estimate_text(). Without an interval the ends are
/// dashes.
struct Estimate {
  Quantity value, low, high;
  bool has_interval = false;
  Line interval() const;  ///< Returns "84.96 … 85.06", or a dash.
};
/// Formats an estimate with its interval.
///
/// @param bounds  range that the value cannot leave, SI
Estimate estimate(const Number& value_si, const Interval& interval, double si_per_unit,
                  const Range& bounds = kAnywhere);

}  // namespace rigcal::report::doc
