#include "model/solver/repeated_steps.hpp"

#include <catch2/catch.hpp>

using namespace rigcal::model;

namespace {

/// State after a period of one second in which steps ended at 0.1, 0.3 (forced) and 0.6.
RepeatedSteps after_a_period() {
  RepeatedSteps steps(SampledPeriod{1.0, 10});
  steps.note(0.1, false);
  steps.note(0.3, true);
  steps.note(0.6, false);
  steps.note(1.0, false);
  return steps;
}

}  // namespace

TEST_CASE("repeated_steps: end where one ended a period ago, if that is about as far", "[model]") {
  RepeatedSteps steps = after_a_period();
  const auto at = [&steps](double t, double planned) { return steps.follow(t, planned).size_s; };
  CHECK(at(1.0, 0.12) == Approx(0.1));
  CHECK_FALSE(steps.follow(1.0, 0.12).forced);
  CHECK(at(1.0, 0.095) == Approx(0.1));  // slightly longer than planned
  CHECK(at(1.0, 0.05) == 0.05);          // too far beyond the planned step
  CHECK(at(1.0, 0.15) == 0.15);          // too short by more than a third
  CHECK(at(1.1, 1.0) == Approx(0.2));    // a forced step is repeated even if it is much shorter
  CHECK(steps.follow(1.1, 1.0).forced);
  CHECK(at(1.2, 0.11) == Approx(0.1));  // starts between two ends
  CHECK(at(1.3, 0.65) == Approx(0.7));  // the last end within reach
  CHECK(at(1.3, 0.3) == Approx(0.3));   // the longer step was rejected before
  CHECK(at(2.5, 0.3) == 0.3);           // beyond all known ends
}

TEST_CASE("repeated_steps: an instant is not left by a step of its rounding", "[model]") {
  RepeatedSteps steps(SampledPeriod{0.1, 100});
  for (int k = 1; k <= 1000; ++k) steps.note(0.1 * k / 3.0, true);
  for (int k = 4; k <= 900; ++k) CHECK(steps.follow(0.1 * k / 3.0, 1e-9).size_s == 1e-9);
}

TEST_CASE("repeated_steps: in the first period, and without one, steps are as planned", "[model]") {
  RepeatedSteps first = after_a_period();
  CHECK(first.follow(0.5, 0.12).size_s == 0.12);
  RepeatedSteps none({});
  none.note(0.1, false);
  CHECK(none.follow(5.0, 0.12).size_s == 0.12);
  CHECK_FALSE(none.follow(5.0, 0.12).forced);
}
