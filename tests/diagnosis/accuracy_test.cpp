#include "diagnosis/accuracy.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "tests/support/golden.hpp"

using namespace rigcal::diagnosis;
using Catch::WithinAbs;
using rigcal::datasets::LeakClass;

TEST_CASE("wilson_interval: the paper's 17 of 18", "[diagnosis]") {
  // R's prop.test(17, 18, correct = FALSE) gives 0.7424 to 0.9901.
  const auto [low, high] = wilson_interval(17.0 / 18.0, 18.0);
  CHECK_THAT(low, WithinAbs(0.7424, 5e-5));
  CHECK_THAT(high, WithinAbs(0.9901, 5e-5));
}

TEST_CASE("accuracy_of: undecided is wrong, and repeats are no trials", "[diagnosis]") {
  std::vector<Judged> judged;
  for (int repeat = 0; repeat < 5; ++repeat) {
    judged.push_back({"a", LeakClass::normal, LeakClass::normal});
    judged.push_back({"b", LeakClass::medium, LeakClass::medium});
  }
  judged[0].found.reset();
  judged[2].found = LeakClass::critical;
  judged[3].found = LeakClass::normal;
  const Accuracy found = accuracy_of(judged);
  CHECK(found.records == 10);
  CHECK(found.right == 7);
  CHECK(found.undecided == 1);
  CHECK(found.off_by_two_or_more == 2);
  CHECK(found.conditions == 2);
  CHECK(found.confusion.counts[0][5] == 1);
  CHECK(found.confusion.counts[2][0] == 1);
  CHECK(found.accuracy_ci95 == wilson_interval(0.7, 2.0));
}

TEST_CASE("wilson_interval: golden values of statsmodels", "[diagnosis]") {
  for (const std::vector<double>& line : rigcal::test::golden_lines("wilson")) {
    CAPTURE(line);
    const auto [low, high] = wilson_interval(line[0] / line[1], line[1]);
    CHECK_THAT(low, WithinAbs(line[2], 1e-9));
    CHECK_THAT(high, WithinAbs(line[3], 1e-9));
  }
}

TEST_CASE("accuracy_of: one class beside is near, two are not", "[diagnosis]") {
  const auto off_by_two = [](LeakClass truth, LeakClass found) {
    return accuracy_of({{"a", truth, found}}).off_by_two_or_more;
  };
  CHECK(off_by_two(LeakClass::normal, LeakClass::slight) == 0);
  CHECK(off_by_two(LeakClass::slight, LeakClass::normal) == 0);
  CHECK(off_by_two(LeakClass::normal, LeakClass::medium) == 1);
  CHECK(off_by_two(LeakClass::critical, LeakClass::slight) == 1);
  CHECK(off_by_two(LeakClass::supercritical, LeakClass::normal) == 1);
}

TEST_CASE("accuracy_of: nothing judged says nothing", "[diagnosis]") {
  const Accuracy none = accuracy_of({});
  CHECK(none.records == 0);
  CHECK_FALSE(none.accuracy);
  CHECK_FALSE(none.accuracy_ci95);
  CHECK(none.confusion.found.back() == "undecided");
}
