#include "calib/trust/interval_advice.hpp"

#include <catch2/catch.hpp>

#include "tests/calib/twin.hpp"

namespace rigcal::calib {

using Catch::Contains;
using Catch::WithinRel;

TEST_CASE("between repeats: the least p counts for all unknowns", "[calib]") {
  Twin twin;
  twin.free("mass", 80.0, 10.0, 500.0);
  twin.free("valve_gain", 4e-5, 1e-5, 2e-4);
  twin.add("sine", datasets::Waveform::sine, 5.0, 0.01);
  const auto records = twin.records(20, 500.0, 1);
  const Problem problem = problem_of(twin, records);
  Uncertainty found;
  found.repeats_ratio = {1.5, 3.0};
  found.repeats_p = {0.3, 0.02};
  found.from_repeats = {false, true};
  found.difference = LikelyDifference{"start", 0.002, 0.95};
  const auto repeats = between_repeats(problem, found);
  REQUIRE(repeats.has_value());
  CHECK(repeats->ratio == 3.0);
  CHECK_THAT(repeats->p, WithinRel(0.04, 1e-12));
  CHECK(repeats->differ);
  CHECK(repeats->parameters == std::vector<std::string>{problem.name(1)});
  CHECK_THAT(between_repeats_warning(*repeats), Contains("standard deviation 2 ms") &&
                                                    Contains("up to 3 times") &&
                                                    Contains("p = 0.04"));
  found.repeats_p = {0.3, 0.03};
  // The repeats differ compared with their own noise, but not compared with the residuals.
  found.difference->p = 0.002;
  CHECK(between_repeats(problem, found)->differ);
  CHECK(between_repeats(problem, found)->p == 0.002);
  found.difference = LikelyDifference{"supply_pressure", 0.02, 0.95};
  CHECK_THAT(between_repeats_warning(*between_repeats(problem, found)),
             Contains("supply_pressure varied by 2 %") && Contains("channel `supply_pressure`") &&
                 Contains("`between_repeats` of supply_pressure"));
  found.difference.reset();
  CHECK_FALSE(between_repeats(problem, found)->differ);
  CHECK(between_repeats_warning(*between_repeats(problem, found)).empty());
  found.repeats_ratio = {0.0, 0.0};
  CHECK_FALSE(between_repeats(problem, found));
}

}  // namespace rigcal::calib
