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
  trend.first_day = *day_of("2026-01-01");
  trend.last_day = *day_of("2026-03-02");
  trend.dates = 3;
  trend.share_per_day = 0.002;
  trend.share_per_day_ci95 = {0.0015, 0.0025};
  trend.p = 0.003;
  trend.significant = true;
  trend.next_class = datasets::LeakClass::medium;
  trend.next_limit = 0.1;
  trend.reached_day = trend.last_day + 20.0;
  trend.earliest_day = trend.last_day + 16.0;
  trend.latest_day = trend.last_day + 26.7;
  return trend;
}

}  // namespace

TEST_CASE("trend_sentence: how fast, how surely, and how long it takes", "[report]") {
  LeakTrend trend = rising();
  CHECK(report::trend_sentence(trend) ==
        "seal, specimen B: the leak rises by 6.00 percentage points of the servo flow in 30 days "
        "(4.50 to 7.50) at sine 1 Hz (over 3 dates from 2026-01-01 to 2026-03-02, p = 0.003). At "
        "this rate it reaches medium (10 %) about 2026-03-22 (2026-03-18 to 2026-03-28).");
  trend.latest_day.reset();
  CHECK_THAT(report::trend_sentence(trend), Contains("(2026-03-18 to never, as far as is known)"));
  trend.reached_day = trend.last_day + 181.0;  // more than three times the 60 days observed
  CHECK_THAT(report::trend_sentence(trend), !Contains("At this rate"));
  trend.share_per_day = -0.002;
  trend.share_per_day_ci95 = {-0.0025, -0.0015};
  trend.widened = 1.5;
  CHECK_THAT(
      report::trend_sentence(trend),
      Contains("falls by 6.00 percentage points of the servo flow in 30 days (4.50 to 7.50)") &&
          Contains("farther off a line"));
}

TEST_CASE("trend_sentence: none", "[report]") {
  LeakTrend trend = rising();
  trend.leak_level = trend.specimen = "";
  trend.significant = false;
  trend.share_per_day_ci95 = {-0.001, 0.002};
  trend.next_class.reset();
  CHECK(report::trend_sentence(trend) ==
        "The machine: no significant trend (over 3 dates from 2026-01-01 to 2026-03-02, p = "
        "0.003): -3.0 to 6.0 percentage points of the servo flow in 30 days at sine 1 Hz.");
}

TEST_CASE("leak_trend: shares in percent, dates in words", "[report]") {
  const report::StoredLeakTrend told = report::stored(rising());
  CHECK(told.share_percent_per_day == 0.2);
  CHECK(told.last_date == "2026-03-02");
  REQUIRE(told.next_limit);
  CHECK(told.next_limit->class_ == datasets::LeakClass::medium);
  CHECK(told.next_limit->percent == 10.0);
  CHECK(told.next_limit->latest == "2026-03-28");
}
