#include "calib/score/scorecard.hpp"

#include <atomic>
#include <catch2/catch.hpp>

#include "tests/calib/twin.hpp"

namespace rigcal::calib {

TEST_CASE("scorecard: the residual is measured minus simulated, of the longest stretch",
          "[calib]") {
  Twin twin;
  twin.add("sine", datasets::Waveform::sine, 5.0, 0.01).windows = {{0.0995, 0.2995},
                                                                   {0.3995, 0.9995}};
  auto records = twin.records(1000, 1000.0, 3);
  for (double& each : records[0].channels[datasets::Channel::position].mean) each += 1e-4;
  const Problem problem = problem_of(twin, records);
  REQUIRE(problem.conditions[0].rows.size() == 800);
  const auto scores = score_conditions(problem, problem.start(), 1);
  const auto& tests = scores.at(0).channels.at(0).residual_tests;
  REQUIRE(tests.has_value());
  CHECK(tests->samples == 600);
  // The standard error is the noise, 5e-5, divided by the square root of 600; the limit is about
  // four times that.
  CHECK_THAT(tests->drift.mean, Catch::WithinAbs(1e-4, 1e-5));
}

TEST_CASE("scorecard: a job that was ended scores nothing more, and says why", "[calib]") {
  Twin twin;
  twin.add("sine", datasets::Waveform::sine, 5.0, 0.01);
  twin.add("square", datasets::Waveform::square, 2.0, 0.01);
  const auto records = twin.records(200, 1000.0, 3);
  Problem problem = problem_of(twin, records);
  const std::atomic<bool> cancel{true};
  problem.cancel = &cancel;
  const auto scores = score_conditions(problem, problem.start(), 1);
  REQUIRE(scores.size() == 2);
  for (const ConditionScore& score : scores) {
    CHECK(score.not_scored == "stopped on request");
    CHECK(score.failure.empty());
    CHECK(score.channels.empty());
    CHECK(score.series.count(datasets::Channel::position) == 1);
  }
}

}  // namespace rigcal::calib
