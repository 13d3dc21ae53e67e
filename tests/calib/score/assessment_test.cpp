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

TEST_CASE("assessment: a note makes no state", "[calib]") {
  const Reason note = reason(AspectState::note, "exact_values", "conditional on 2 known values");
  CHECK(aspect_of({note}).state == AspectState::not_assessed);
  const Aspect passed = aspect_of({note, reason(AspectState::pass, "identified", "1 of 1")});
  CHECK(passed.state == AspectState::pass);
  CHECK(passed.reasons.back().code == "exact_values");
  CHECK(is_against(AspectState::not_assessed));
  CHECK_FALSE(is_against(AspectState::note));
}

TEST_CASE("assessment: what is not validated has no range of validity", "[calib]") {
  using enum AspectState;
  CHECK(has_range_of_validity(pass, pass));
  CHECK(has_range_of_validity(reservation, reservation));
  CHECK_FALSE(has_range_of_validity(fail, pass));
  CHECK_FALSE(has_range_of_validity(pass, fail));
  CHECK_FALSE(has_range_of_validity(pass, not_assessed));
}

}  // namespace rigcal::calib
