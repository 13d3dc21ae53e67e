#include "metrics/test_outcome.hpp"

#include <catch2/catch.hpp>
#include <limits>

namespace {

using rigcal::metrics::judge;
using rigcal::metrics::Judged;
using rigcal::metrics::TestOutcome;

}  // namespace

TEST_CASE("judge: a pass needs power, a failure a level that holds", "[metrics]") {
  const auto outcome = [](bool rejects, double samples, double bound) {
    return judge(rejects, {samples, bound, 0.5, "a correlation"}).outcome;
  };
  CHECK(outcome(false, 100.0, 0.3) == TestOutcome::passed);
  CHECK(outcome(true, 100.0, 0.3) == TestOutcome::failed);
  // A rejection counts even if the test is weak.
  CHECK(outcome(true, 10.0, 0.9) == TestOutcome::failed);
  CHECK(outcome(false, 10.0, 0.5) == TestOutcome::passed);
  CHECK(outcome(false, 10.0, 0.51) == TestOutcome::not_judged);
  CHECK(outcome(true, 9.9, 0.3) == TestOutcome::not_judged);
  CHECK(outcome(false, 9.9, 0.3) == TestOutcome::not_judged);
  CHECK(outcome(true, std::numeric_limits<double>::quiet_NaN(), 0.3) == TestOutcome::not_judged);
}

TEST_CASE("judge: says why it cannot", "[metrics]") {
  const Judged few = judge(false, {3.7, 0.3, 0.5, "a correlation"});
  CHECK(few.reason == "effective sample size 3, at least 10 needed");
  const Judged wide = judge(false, {12.9, 0.834, 0.5, "a correlation"});
  CHECK(wide.reason == "a correlation below 0.83 would not be detected (effective sample size 12)");
  CHECK_FALSE(judge(false, {100.0, 0.3, 0.5, "a correlation"}).reason);
  CHECK_FALSE(judge(true, {100.0, 0.3, 0.5, "a correlation"}).reason);
  CHECK_FALSE(few.passed());
  CHECK_FALSE(few.failed());
}

TEST_CASE("TestOutcome: names of the result file", "[metrics]") {
  CHECK(to_string(TestOutcome::passed) == "passed");
  CHECK(to_string(TestOutcome::failed) == "failed");
  CHECK(to_string(TestOutcome::not_judged) == "not_judged");
}
