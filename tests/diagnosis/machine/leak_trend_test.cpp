#include "diagnosis/machine/leak_trend.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "common/calendar.hpp"

using namespace rigcal;
using Catch::Contains;
using Catch::WithinAbs;
using Catch::WithinRel;
using diagnosis::LeakTrend;
using diagnosis::MachineState;

namespace {

const Eigen::MatrixXd kNoRig = Eigen::MatrixXd::Zero(0, 0);

/// A state on a date, with share = 0.2 C.
MachineState on(const std::string& date, double coefficient, double own_se, double freedom = 1e6,
                double move = 0.0) {
  MachineState state;
  state.key = diagnosis::StateKey{"seal", {}, date};
  state.members.emplace_back();
  state.pooled.coefficient = coefficient;
  state.pooled.error.own_se = own_se;
  state.pooled.error.freedom = freedom;
  state.pooled.rig_moves = Eigen::VectorXd::Constant(1, move);
  state.duty = "sine 1 Hz";
  state.estimate.share = 0.2 * coefficient;
  state.share_slope = 0.2;
  return state;
}

LeakTrend only_trend(const std::vector<MachineState>& states, const Eigen::MatrixXd& rig = kNoRig) {
  const auto trends = diagnosis::leak_trends(states, rig, {});
  REQUIRE(trends.size() == 1);
  return trends.front();
}

}  // namespace

TEST_CASE("leak_trends: two dates are no trend, and said so", "[diagnosis]") {
  const std::vector states{on("2026-01-11", 0.5, 0.003), on("2026-01-01", 0.3, 0.004)};
  CHECK(diagnosis::leak_trends(states, kNoRig, {}).empty());
  const auto texts = diagnosis::too_few_dates(states);
  REQUIRE(texts.size() == 1);
  CHECK_THAT(texts.front(), Catch::Contains("2026-01-01 and 2026-01-11"));
  CHECK(diagnosis::too_few_dates({on("2026-01-01", 0.3, 0.01)}).empty());
  const std::vector three{states[0], states[1], on("2026-01-21", 0.5, 0.003)};
  CHECK(diagnosis::too_few_dates(three).empty());
}

TEST_CASE("leak_trends: the line through three dates, in their order", "[diagnosis]") {
  // Only the two ends have weight in the slope. With 4 degrees of freedom each, their sum has 8.
  const LeakTrend trend =
      only_trend({on("2026-01-11", 0.5, 0.03, 4.0), on("2026-01-01", 0.3, 0.03, 4.0),
                  on("2026-01-06", 0.4, 0.01, 1.0)});
  CHECK(trend.dates == 3);
  CHECK(trend.first_date == "2026-01-01");
  CHECK(trend.last_date == "2026-01-11");
  CHECK_THAT(trend.coefficient_per_day, WithinRel(0.02, 1e-9));
  CHECK_THAT(trend.share_percent_per_day, WithinRel(0.4, 1e-9));
  // The error is 0.03 sqrt(2) / 10 per day. The factor is the 97.5 % quantile of t with 8 degrees
  // of freedom.
  CHECK_THAT(trend.share_percent_per_day_ci95.high - trend.share_percent_per_day,
             WithinRel(20.0 * 0.003 * std::sqrt(2.0) * 2.306004135, 1e-6));
  CHECK(trend.significant);
  CHECK(trend.widened == 1.0);
}

TEST_CASE("leak_trends: when the line reaches the next limit", "[diagnosis]") {
  // The share is 2 % on the last day and rises by 0.4 points per day, so it reaches 10 %, where
  // medium begins, 20 days later.
  const LeakTrend trend = only_trend(
      {on("2026-01-01", 0.06, 1e-3), on("2026-01-02", 0.08, 1e-3), on("2026-01-03", 0.1, 1e-3)});
  REQUIRE(trend.next_limit);
  CHECK(trend.next_limit->class_ == datasets::LeakClass::medium);
  CHECK_THAT(trend.next_limit->percent, WithinAbs(10.0, 1e-10));
  const int last_day = day_of(trend.last_date).value();
  CHECK_THAT(trend.next_limit->reached_day - last_day, WithinRel(20.0, 1e-9));
  CHECK(trend.next_limit->earliest < "2026-01-23");
  REQUIRE(trend.next_limit->latest);
  CHECK(*trend.next_limit->latest > "2026-01-23");
  // If the share falls, or is beyond the last limit, there is no limit to reach.
  for (const double change : {-0.1, 0.2}) {
    const double first = change < 0.0 ? 0.3 : 2.0;
    const LeakTrend other =
        only_trend({on("2026-01-01", first, 1e-3), on("2026-01-02", first + change, 1e-3),
                    on("2026-01-03", first + 2.0 * change, 1e-3)});
    CHECK(other.significant);
    CHECK_FALSE(other.next_limit);
  }
}

TEST_CASE("leak_trends: no trend within the errors", "[diagnosis]") {
  const LeakTrend trend = only_trend(
      {on("2026-01-01", 0.30, 0.02), on("2026-01-02", 0.31, 0.02), on("2026-01-03", 0.30, 0.02)});
  CHECK_FALSE(trend.significant);
  CHECK_THAT(trend.p_value, WithinAbs(1.0, 1e-9));
  CHECK_FALSE(trend.next_limit);
  const LeakTrend rise = only_trend(
      {on("2026-01-01", 0.30, 0.02), on("2026-01-02", 0.305, 0.02), on("2026-01-03", 0.31, 0.02)});
  CHECK(rise.coefficient_per_day > 0.0);
  CHECK_FALSE(rise.significant);
  CHECK_FALSE(rise.next_limit);
}

TEST_CASE("leak_trends: an error that all dates share is no trend", "[diagnosis]") {
  // If the rig is known only within 50 %, this error shifts all dates alike.
  const Eigen::MatrixXd rig = Eigen::MatrixXd::Constant(1, 1, 0.25);
  const auto states = [](double move) {
    return std::vector{on("2026-01-01", 0.3, 0.01, 1e6, move),
                       on("2026-01-06", 0.35, 0.01, 1e6, move),
                       on("2026-01-11", 0.4, 0.01, 1e6, move)};
  };
  const LeakTrend exact = only_trend(states(0.0), rig);
  const LeakTrend shared = only_trend(states(0.3), rig);
  CHECK_THAT(shared.p_value, WithinRel(exact.p_value, 1e-6));
  CHECK_THAT(shared.coefficient_per_day, WithinRel(0.01, 1e-9));
  // The error matters only if it shifts the estimate of one date more than that of another: here by
  // 0.1 * 0.5 over ten days.
  const LeakTrend uneven =
      only_trend({on("2026-01-01", 0.3, 0.01, 1e6, 0.3), on("2026-01-06", 0.35, 0.01, 1e6, 0.35),
                  on("2026-01-11", 0.4, 0.01, 1e6, 0.4)},
                 rig);
  const double error =
      (uneven.share_percent_per_day_ci95.high - uneven.share_percent_per_day) / (20.0 * 1.95996);
  CHECK_THAT(error, WithinRel(std::sqrt(2e-4 + 0.0025) / 10.0, 1e-3));
}

TEST_CASE("leak_trends: dates that lie off a line widen its error", "[diagnosis]") {
  // The values are 0, 6, 0, 6 errors of 0.01. Around the line 1.2 x + 1.2 errors, chi-square is
  // 28.8 with 2 degrees of freedom.
  const LeakTrend trend = only_trend({on("2026-01-01", 0.30, 0.01), on("2026-01-02", 0.36, 0.01),
                                      on("2026-01-03", 0.30, 0.01), on("2026-01-04", 0.36, 0.01)});
  CHECK_THAT(trend.coefficient_per_day, WithinRel(0.012, 1e-9));
  CHECK_THAT(trend.chi_squared, WithinRel(28.8, 1e-9));
  CHECK(trend.freedom == 2.0);
  CHECK_THAT(trend.widened, WithinRel(std::sqrt(14.4), 1e-9));
  // The error of the slope without that factor: sum (x - 1.5)^2 = 5.
  CHECK_THAT(trend.coefficient_per_day_error, WithinRel(0.01 / std::sqrt(5.0), 1e-9));
  CHECK_FALSE(trend.significant);
}

TEST_CASE("leak_trends: one for each machine, of dated verdicts alone", "[diagnosis]") {
  std::vector<MachineState> states;
  for (const char* date : {"2026-01-01", "2026-01-02", "2026-01-04"}) {
    states.push_back(on(date, 0.3, 0.01));
    states.push_back(on(date, 0.5, 0.01));
    states.back().key.specimen = "B";
  }
  states.push_back(on("", 0.5, 0.01));
  states.push_back(on("2026-01-03", 0.9, 0.01));
  states.back().failure = "no verdict";
  const auto trends = diagnosis::leak_trends(states, kNoRig, {});
  REQUIRE(trends.size() == 2);
  CHECK_FALSE(trends[0].specimen);
  CHECK(trends[0].dates == 3);
  CHECK(trends[1].specimen == "B");
  CHECK(diagnosis::leak_trends({on("2026-01-01", 0.3, 0.01)}, kNoRig, {}).empty());
}

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

TEST_CASE("trend_sentence: how fast, how surely, and how long it takes", "[diagnosis]") {
  LeakTrend trend = rising();
  CHECK(diagnosis::trend_sentence(trend) ==
        "seal, specimen B: the leak rises by 6.00 percentage points of the servo flow in 30 days "
        "(4.50 to 7.50) at sine 1 Hz (over 3 dates from 2026-01-01 to 2026-03-02, p = 0.003). At "
        "this rate it reaches medium (10 %) about 2026-03-22 (2026-03-18 to 2026-03-28).");
  trend.next_limit->latest_day.reset();
  CHECK_THAT(diagnosis::trend_sentence(trend), Contains("(2026-03-18 to no upper limit)"));
  trend.next_limit->reached_day += 161.0;  // more than three times the 60 days observed
  CHECK_THAT(diagnosis::trend_sentence(trend), !Contains("At this rate"));
  trend.share_percent_per_day = -0.2;
  trend.share_percent_per_day_ci95 = {-0.25, -0.15};
  trend.widened = 1.5;
  CHECK_THAT(
      diagnosis::trend_sentence(trend),
      Contains("falls by 6.00 percentage points of the servo flow in 30 days (4.50 to 7.50)") &&
          Contains("scatter about the line"));
}

TEST_CASE("trend_sentence: none", "[diagnosis]") {
  LeakTrend trend = rising();
  trend.leak_level = trend.specimen = std::nullopt;
  trend.significant = false;
  trend.share_percent_per_day_ci95 = {-0.1, 0.2};
  trend.next_limit.reset();
  CHECK(diagnosis::trend_sentence(trend) ==
        "The machine: no significant trend (over 3 dates from 2026-01-01 to 2026-03-02, p = "
        "0.003): -3.0 to 6.0 percentage points of the servo flow in 30 days at sine 1 Hz.");
}
