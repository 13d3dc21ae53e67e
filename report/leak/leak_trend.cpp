#include "report/leak/leak_trend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/calendar.hpp"
#include "report/leak/leak_estimate.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

using diagnosis::LeakTrend;

/// Number of days over which the change is reported.
constexpr double kDays = 30.0;

std::string machine_of(const LeakTrend& trend) {
  diagnosis::StateKey key;
  key.leak_level = trend.leak_level;
  key.specimen = trend.specimen;
  const std::string name = key.name();
  return name.empty() ? "The machine" : name;
}

/// Returns true if a day is too far in the future to be predicted from the records.
bool is_far(const LeakTrend& trend, double day) {
  return day - trend.last_day > kAhead * (trend.last_day - trend.first_day);
}

std::string next_limit_of(const LeakTrend& trend) {
  if (!trend.next_class || is_far(trend, trend.reached_day)) return {};
  const bool open = !trend.latest_day || is_far(trend, *trend.latest_day);
  return fmt::format(" At this rate it reaches {} ({:g} %) about {} ({} to {}).",
                     to_string(*trend.next_class), kInPercent * trend.next_limit,
                     date_of(trend.reached_day), date_of(trend.earliest_day),
                     open ? "never, as far as is known" : date_of(*trend.latest_day));
}

}  // namespace

std::string trend_sentence(const LeakTrend& trend) {
  const auto [low, high] = trend.share_per_day_ci95;
  const double points = kInPercent * kDays;  // converts to percent of the servo flow per kDays
  const double error = std::max(0.005, points * (high - low) / 4.0);
  const auto text = [&](double per_day) { return to_uncertainty(points * per_day, error); };
  const std::string over =
      fmt::format("over {} dates from {} to {}, {}", trend.dates, date_of(trend.first_day),
                  date_of(trend.last_day), p_value_text(trend.p));
  std::string sentence;
  if (!trend.significant) {
    sentence = fmt::format(
        "{}: no significant trend ({}): {} to {} percentage points of the servo flow in {:g} days "
        "at {}.",
        machine_of(trend), over, text(low), text(high), kDays, trend.duty);
  } else {
    const bool rises = trend.share_per_day > 0.0;
    sentence = fmt::format(
        "{}: the leak {} by {} percentage points of the servo flow in {:g} days ({} to {}) at {} "
        "({}).",
        machine_of(trend), rises ? "rises" : "falls", text(std::abs(trend.share_per_day)), kDays,
        text(rises ? low : -high), text(rises ? high : -low), trend.duty, over);
  }
  if (trend.widened > 1.0)
    sentence +=
        " The dates lie farther off a line than their errors allow; the interval is widened "
        "for it.";
  return sentence + next_limit_of(trend);
}

StoredLeakTrend stored(const LeakTrend& trend) {
  StoredLeakTrend told;
  told.leak_level = unless_empty(trend.leak_level);
  told.specimen = unless_empty(trend.specimen);
  told.sentence = trend_sentence(trend);
  told.dates = trend.dates;
  told.first_date = date_of(trend.first_day);
  told.last_date = date_of(trend.last_day);
  told.duty = trend.duty;
  told.coefficient_per_day = trend.coefficient_per_day;
  told.share_percent_per_day = kInPercent * trend.share_per_day;
  told.share_percent_per_day_ci95 = scaled_ends(trend.share_per_day_ci95, kInPercent);
  told.p_value = trend.p;
  told.significant = trend.significant;
  told.chi_squared = trend.chi_squared;
  told.freedom = trend.freedom;
  told.widened = trend.widened;
  if (!trend.next_class) return told;
  told.next_limit = {*trend.next_class, kInPercent * trend.next_limit, date_of(trend.reached_day),
                     date_of(trend.earliest_day), std::nullopt};
  if (trend.latest_day) told.next_limit->latest = date_of(*trend.latest_day);
  return told;
}

}  // namespace rigcal::report
