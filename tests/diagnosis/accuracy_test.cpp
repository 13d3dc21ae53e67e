#include "diagnosis/accuracy.hpp"

#include <catch2/catch.hpp>

using namespace rigcal::diagnosis;
using Catch::WithinAbs;
using rigcal::datasets::LeakClass;

TEST_CASE("wilson_interval: the paper's 17 of 18", "[diagnosis]") {
  // R's prop.test(17, 18, correct = FALSE): 0.7424 to 0.9901.
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
  CHECK(found.off_by_two == 2);
  CHECK(found.conditions == 2);
  CHECK(found.confusion[0][5] == 1);
  CHECK(found.confusion[2][0] == 1);
  CHECK(found.ci95 == wilson_interval(0.7, 2.0));
}

TEST_CASE("accuracy_of: nothing judged says nothing", "[diagnosis]") {
  const Accuracy none = accuracy_of({});
  CHECK(none.records == 0);
  CHECK(none.ci95 == std::pair{0.0, 1.0});
}
