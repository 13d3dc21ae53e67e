#include "diagnosis/leak_trend.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace rigcal;
using Catch::WithinAbs;
using Catch::WithinRel;
using diagnosis::LeakTrend;
using diagnosis::MachineState;

namespace {

const Eigen::MatrixXd kNoRig = Eigen::MatrixXd::Zero(0, 0);

/// share = 0.2 C.
MachineState on(const std::string& date, double coefficient, double own_se, double freedom = 1e6,
                double move = 0.0) {
  MachineState state;
  state.key = {"seal", "", date};
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

TEST_CASE("leak_trends: two dates are a difference over its days", "[diagnosis]") {
  const LeakTrend trend =
      only_trend({on("2026-01-11", 0.5, 0.03, 9.0), on("2026-01-01", 0.3, 0.04, 4.0)});
  CHECK(trend.dates == 2);
  CHECK(trend.last_day - trend.first_day == 10);
  CHECK_THAT(trend.coefficient_per_day, WithinRel(0.02, 1e-9));
  CHECK_THAT(trend.share_per_day, WithinRel(0.004, 1e-9));
  // Error 0.05 / 10 per day; Welch's freedom 0.05^4 / (0.03^4 / 9 + 0.04^4 / 4) = 8.56, of which
  // the quantile of Student's t is 2.27994 and the tail beyond 4 is 0.00172045 on each side
  // (SciPy).
  CHECK_THAT(trend.share_per_day_ci95.second - trend.share_per_day,
             WithinRel(0.2 * 0.005 * 2.27994, 1e-5));
  CHECK_THAT(trend.p, WithinRel(2.0 * 0.00172045, 1e-5));
  CHECK(trend.significant);
  CHECK(trend.widened == 1.0);
}

TEST_CASE("leak_trends: when the line reaches the next limit", "[diagnosis]") {
  // 2 % on the last day, 0.4 points a day: 10 %, where medium begins, 20 days later.
  const LeakTrend trend = only_trend({on("2026-01-01", 0.06, 1e-3), on("2026-01-03", 0.1, 1e-3)});
  REQUIRE(trend.next_class == datasets::LeakClass::medium);
  CHECK_THAT(trend.next_limit, WithinAbs(0.1, 1e-12));
  CHECK_THAT(trend.reached_day - trend.last_day, WithinRel(20.0, 1e-9));
  CHECK(trend.earliest_day < trend.reached_day);
  REQUIRE(trend.latest_day);
  CHECK(*trend.latest_day > trend.reached_day);
  // Falling, or beyond the last limit: nothing to reach.
  CHECK_FALSE(only_trend({on("2026-01-01", 0.3, 1e-3), on("2026-01-03", 0.1, 1e-3)}).next_class);
  CHECK_FALSE(only_trend({on("2026-01-01", 2.0, 1e-3), on("2026-01-03", 2.4, 1e-3)}).next_class);
}

TEST_CASE("leak_trends: no trend within the errors", "[diagnosis]") {
  const LeakTrend trend = only_trend(
      {on("2026-01-01", 0.30, 0.02), on("2026-01-02", 0.31, 0.02), on("2026-01-03", 0.30, 0.02)});
  CHECK_FALSE(trend.significant);
  CHECK_THAT(trend.p, WithinAbs(1.0, 1e-9));
  CHECK_FALSE(trend.next_class);
  const LeakTrend rise = only_trend({on("2026-01-01", 0.30, 0.02), on("2026-01-02", 0.31, 0.02)});
  CHECK(rise.coefficient_per_day > 0.0);
  CHECK_FALSE(rise.significant);
  CHECK_FALSE(rise.next_class);
}

TEST_CASE("leak_trends: an error that all dates share is no trend", "[diagnosis]") {
  // A rig that is known within 50 % moves every date alike.
  const Eigen::MatrixXd rig = Eigen::MatrixXd::Constant(1, 1, 0.25);
  const auto states = [](double move) {
    return std::vector{on("2026-01-01", 0.3, 0.01, 1e6, move),
                       on("2026-01-11", 0.4, 0.01, 1e6, move)};
  };
  const LeakTrend exact = only_trend(states(0.0), rig);
  const LeakTrend shared = only_trend(states(0.3), rig);
  CHECK_THAT(shared.p, WithinRel(exact.p, 1e-6));
  CHECK_THAT(shared.coefficient_per_day, WithinRel(0.01, 1e-9));
  // It counts where it moves one date more than the other: by 0.1 * 0.5 over ten days.
  const LeakTrend uneven = only_trend(
      {on("2026-01-01", 0.3, 0.01, 1e6, 0.3), on("2026-01-11", 0.4, 0.01, 1e6, 0.4)}, rig);
  const double error = (uneven.share_per_day_ci95.second - uneven.share_per_day) / (0.2 * 1.95996);
  CHECK_THAT(error, WithinRel(std::sqrt(2e-4 + 0.0025) / 10.0, 1e-3));
}

TEST_CASE("leak_trends: dates that lie off a line widen its error", "[diagnosis]") {
  // 0, 6, 0, 6 errors of 0.01: about the line 1.2 x + 1.2 errors, chi-square 28.8 of 2 degrees.
  const LeakTrend trend = only_trend({on("2026-01-01", 0.30, 0.01), on("2026-01-02", 0.36, 0.01),
                                      on("2026-01-03", 0.30, 0.01), on("2026-01-04", 0.36, 0.01)});
  CHECK_THAT(trend.coefficient_per_day, WithinRel(0.012, 1e-9));
  CHECK_THAT(trend.chi_squared, WithinRel(28.8, 1e-9));
  CHECK(trend.freedom == 2.0);
  CHECK_THAT(trend.widened, WithinRel(std::sqrt(14.4), 1e-9));
  CHECK_FALSE(trend.significant);
}

TEST_CASE("leak_trends: one for each machine, of dated verdicts alone", "[diagnosis]") {
  std::vector<MachineState> states{on("2026-01-01", 0.3, 0.01), on("2026-01-02", 0.3, 0.01),
                                   on("2026-01-01", 0.5, 0.01), on("2026-01-02", 0.5, 0.01),
                                   on("", 0.5, 0.01),           on("2026-01-03", 0.9, 0.01)};
  states[2].key.specimen = states[3].key.specimen = "B";
  states[5].failure = "no verdict";
  const auto trends = diagnosis::leak_trends(states, kNoRig, {});
  REQUIRE(trends.size() == 2);
  CHECK(trends[0].specimen.empty());
  CHECK(trends[0].dates == 2);
  CHECK(trends[1].specimen == "B");
  CHECK(diagnosis::leak_trends({on("2026-01-01", 0.3, 0.01)}, kNoRig, {}).empty());
}
