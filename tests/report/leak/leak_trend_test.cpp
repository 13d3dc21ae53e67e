#include "report/leak/leak_trend.hpp"

#include <catch2/catch.hpp>

#include "common/calendar.hpp"

using namespace rigcal;
using Catch::Contains;
using diagnosis::LeakTrend;

namespace {

LeakTrend rising() {
  LeakTrend trend;
  trend.leak_level = "seal";
  trend.specimen = "B";
  trend.duty = "sine 1 Hz";
  trend.first_date = "2026-01-01";
  trend.last_date = "2026-03-02";
  trend.dates = 3;
  trend.share_percent_per_day = 0.2;
  trend.share_percent_per_day_ci95 = {0.15, 0.25};
  trend.p_value = 0.003;
  trend.significant = true;
  const double last_day = *day_of(trend.last_date);
  trend.next_limit = {datasets::LeakClass::medium,
                      10.0,
                      "2026-03-22",
                      "2026-03-18",
                      "2026-03-28",
                      last_day + 20.0,
                      last_day + 26.7};
  return trend;
}

}  // namespace

TEST_CASE("trend_sentence: how fast, how surely, and how long it takes", "[report]") {
  LeakTrend trend = rising();
  CHECK(report::trend_sentence(trend) ==
        "seal, specimen B: the leak rises by 6.00 percentage points of the servo flow in 30 days "
        "(4.50 to 7.50) at sine 1 Hz (over 3 dates from 2026-01-01 to 2026-03-02, p = 0.003). At "
        "this rate it reaches medium (10 %) about 2026-03-22 (2026-03-18 to 2026-03-28).");
  trend.next_limit->latest_day.reset();
  CHECK_THAT(report::trend_sentence(trend), Contains("(2026-03-18 to never, as far as is known)"));
  trend.next_limit->reached_day += 161.0;  // more than three times the 60 days observed
  CHECK_THAT(report::trend_sentence(trend), !Contains("At this rate"));
  trend.share_percent_per_day = -0.2;
  trend.share_percent_per_day_ci95 = {-0.25, -0.15};
  trend.widened = 1.5;
  CHECK_THAT(
      report::trend_sentence(trend),
      Contains("falls by 6.00 percentage points of the servo flow in 30 days (4.50 to 7.50)") &&
          Contains("farther off a line"));
}

TEST_CASE("trend_sentence: none", "[report]") {
  LeakTrend trend = rising();
  trend.leak_level = trend.specimen = std::nullopt;
  trend.significant = false;
  trend.share_percent_per_day_ci95 = {-0.1, 0.2};
  trend.next_limit.reset();
  CHECK(report::trend_sentence(trend) ==
        "The machine: no significant trend (over 3 dates from 2026-01-01 to 2026-03-02, p = "
        "0.003): -3.0 to 6.0 percentage points of the servo flow in 30 days at sine 1 Hz.");
}
