#include "report/document/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/significant.hpp"
#include "metrics/metric_table.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report::doc {

namespace {

/// Numbers with at most three digits are measured or computed, so that their zeros count. Those
/// with more may be the user's, such as a limit, and are shown as they were typed.
std::string digits_of(double value, int digits) {
  constexpr int kMeasured = 3;
  return digits <= kMeasured ? measured(value, digits) : significant(value, digits);
}

}  // namespace

Quantity in_unit(const Number& number, double si_per_unit, int digits) {
  if (!number.value) return {};
  return {number.value, digits_of(*number.value / si_per_unit, digits)};
}

Quantity readable(const Number& number, std::string_view si_unit, int digits) {
  if (!number.value) return {};
  if (!std::isfinite(*number.value)) return {number.value, "-"};
  const ReadableUnit unit = readable_unit(*number.value, si_unit);
  return {number.value, digits_of(*number.value / unit.si, digits), std::string(unit.name)};
}

Quantity agreement(const Number& number) {
  if (!number.value) return {};
  return {number.value, agreement_text(*number.value)};
}

Quantity score(std::string_view metric, const Number& number, const std::optional<double>& limit) {
  if (!number.value) return {};
  const metrics::MetricSpec* spec = metrics::find_metric(metric);
  if (spec == nullptr) return in_unit(number, 1.0, 4);
  return {number.value, metrics::score_text(*spec, *number.value, limit)};
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
