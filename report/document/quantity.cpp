#include "report/document/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/significant.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report::doc {

Quantity in_unit(const Number& number, double si_per_unit, int digits) {
  if (!number.value) return {};
  return {number.value, significant(*number.value / si_per_unit, digits)};
}

Quantity readable(const Number& number, std::string_view si_unit, int digits) {
  if (!number.value) return {};
  if (!std::isfinite(*number.value)) return {number.value, "-"};
  const ReadableUnit unit = readable_unit(*number.value, si_unit);
  return {number.value, significant(*number.value / unit.si, digits), std::string(unit.name)};
}

Quantity agreement(const Number& number) {
  if (!number.value) return {};
  return {number.value, agreement_text(*number.value)};
}

Quantity score(std::string_view metric, const Number& number) {
  if (metric == "absolute_error_percent" || !number.value) return in_unit(number, 1.0, 4);
  constexpr int kLeast = 3;
  constexpr int kMost = 10;
  const double missing = std::abs(1.0 - *number.value);
  const int count =
      missing > 0.0
          ? std::clamp(static_cast<int>(std::ceil(-std::log10(missing))) + 1, kLeast, kMost)
          : kLeast;
  return {number.value, fmt::format("{:.{}f}", *number.value, count)};
}

Quantity decimals(const Number& number, int count) {
  if (!number.value) return {};
  return {number.value, fixed(*number.value, count)};
}

Line Estimate::interval() const {
  if (!has_interval) return {"–"};
  return {low, " … ", high};
}

Estimate estimate(const Number& number, const Interval& interval, double si_per_unit,
                  const Range& bounds) {
  if (!number.value) return {};
  const auto in_unit = [&](const Range& range) {
    return Range{range.low / si_per_unit, range.high / si_per_unit};
  };
  const auto& ends = interval.ends;
  const EstimateText text =
      estimate_text(*number.value / si_per_unit,
                    ends ? std::optional(in_unit(*ends)) : std::nullopt, in_unit(bounds));
  Estimate made{{number.value, text.value}, {}, {}, ends.has_value()};
  if (ends) {
    made.low = {ends->low, text.low};
    made.high = {ends->high, text.high};
  }
  return made;
}

}  // namespace rigcal::report::doc
