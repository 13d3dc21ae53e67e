#include "calib/score/assessment.hpp"

#include <catch2/catch.hpp>

#include "tests/calib/assessment_scene.hpp"

namespace rigcal::calib {

TEST_CASE("assessment: PASS needs all four aspects", "[calib]") {
  CHECK(AssessmentScene().verdict() == Verdict::pass);
  Assessment all;
  for (Aspect* aspect : {&all.agreement, &all.validation, &all.adequacy, &all.parameters})
    aspect->state = AspectState::pass;
  CHECK(verdict_of(all) == Verdict::pass);
  for (Aspect* aspect : {&all.agreement, &all.validation, &all.adequacy, &all.parameters}) {
    for (const AspectState state : {AspectState::reservation, AspectState::not_assessed}) {
      aspect->state = state;
      const bool nothing = aspect == &all.agreement && state == AspectState::not_assessed;
      CHECK(verdict_of(all) == (nothing ? std::nullopt : std::optional(Verdict::warn)));
    }
    aspect->state = AspectState::pass;
  }
  all.agreement.state = AspectState::fail;
  CHECK(verdict_of(all) == Verdict::fail);
  all.agreement.state = AspectState::pass;
  all.validation.state = AspectState::fail;
  CHECK(verdict_of(all) == Verdict::fail);
}

}  // namespace rigcal::calib
