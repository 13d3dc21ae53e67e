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

}  // namespace rigcal::calib
