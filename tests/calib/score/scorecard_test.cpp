#include "calib/score/scorecard.hpp"

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

}  // namespace rigcal::calib
