#include "report/leak/leak_trend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/calendar.hpp"
#include "report/store/stored/stored_diagnosis.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

using diagnosis::LeakTrend;

/// Number of days over which the change is reported.
constexpr double kDays = 30.0;

std::string machine_of(const LeakTrend& trend) {
  diagnosis::StateKey key;
  key.leak_level = trend.leak_level.value_or("");
  key.specimen = trend.specimen.value_or("");
  const std::string name = key.name();
  return name.empty() ? "The machine" : name;
}

/// Returns true if a day is too far in the future to be predicted from the records.
bool is_far(const LeakTrend& trend, double day) {
  const int last_day = day_of(trend.last_date).value();
  return day - last_day > kAhead * (last_day - day_of(trend.first_date).value());
}

std::string next_limit_of(const LeakTrend& trend) {
  const auto& limit = trend.next_limit;
  if (!limit || is_far(trend, limit->reached_day)) return {};
  const bool open = !limit->latest_day || is_far(trend, *limit->latest_day);
  return fmt::format(" At this rate it reaches {} ({:g} %) about {} ({} to {}).",
                     to_string(limit->class_), limit->percent, limit->reached, limit->earliest,
                     open ? "never, as far as is known" : *limit->latest);
}

}  // namespace

std::string trend_sentence(const LeakTrend& trend) {
  const auto [low, high] = trend.share_percent_per_day_ci95;
  const double error = std::max(0.005, kDays * (high - low) / 4.0);
  const auto text = [&](double per_day) { return to_uncertainty(kDays * per_day, error); };
  const std::string over =
      fmt::format("over {} dates from {} to {}, {}", trend.dates, trend.first_date, trend.last_date,
                  p_value_text(trend.p_value));
  std::string sentence;
  if (!trend.significant) {
    sentence = fmt::format(
        "{}: no significant trend ({}): {} to {} percentage points of the servo flow in {:g} days "
        "at {}.",
        machine_of(trend), over, text(low), text(high), kDays, trend.duty);
  } else {
    const bool rises = trend.share_percent_per_day > 0.0;
    sentence = fmt::format(
        "{}: the leak {} by {} percentage points of the servo flow in {:g} days ({} to {}) at {} "
        "({}).",
        machine_of(trend), rises ? "rises" : "falls", text(std::abs(trend.share_percent_per_day)),
        kDays, text(rises ? low : -high), text(rises ? high : -low), trend.duty, over);
  }
  if (trend.widened > 1.0)
    sentence +=
        " The dates lie farther off a line than their errors allow; the interval is widened "
        "for it.";
  return sentence + next_limit_of(trend);
}

}  // namespace rigcal::report
