#include "calib/score/judge_validation.hpp"

#include <catch2/catch.hpp>

#include "tests/calib/assessment_scene.hpp"

namespace rigcal::calib {

TEST_CASE("validation: what was fitted does not validate", "[calib]") {
  AssessmentScene scene;
  scene.fitted = {"fitted", "other"};
  CHECK(scene.assessed().validation.state == AspectState::not_assessed);
  CHECK(find(scene.assessed().validation, "no_validation") != nullptr);
  CHECK(scene.verdict() == Verdict::warn);
  scene.fitted = {};
  CHECK(find(scene.assessed().validation, "limits_kept")->numbers.front().second == 2.0);
}

TEST_CASE("validation: a prediction that the estimates leave open is noted", "[calib]") {
  AssessmentScene scene;
  ConditionScore& other = scene.fit.conditions.at(1);
  other.open[datasets::Channel::position] = {0.005, {"mass"}};
  CHECK(find(scene.assessed().validation, "prediction_open") == nullptr);
  other.open[datasets::Channel::position] = {0.3, {"mass", "bulk_modulus"}};
  const Assessment assessed = scene.assessed();
  const Reason* open = find(assessed.validation, "prediction_open");
  REQUIRE(open != nullptr);
  CHECK(open->state == AspectState::note);
  CHECK(open->subject == "other");
  CHECK(open->numbers.front().second == Approx(0.7));
  CHECK_THAT(open->words, Catch::Contains("position") && Catch::Contains("mass, bulk_modulus"));
  CHECK(assessed.validation.state == AspectState::pass);
  // A fitted record is no prediction.
  scene.fitted = {"fitted", "other"};
  CHECK(find(scene.assessed().validation, "prediction_open") == nullptr);
}

}  // namespace rigcal::calib
