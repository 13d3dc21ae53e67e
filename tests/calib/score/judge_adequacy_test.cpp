#include <catch2/catch.hpp>

#include "calib/score/judges.hpp"
#include "tests/calib/assessment_scene.hpp"

namespace rigcal::calib {
namespace {

using Catch::Contains;

}  // namespace

TEST_CASE("adequacy: lack of fit counts where it is significant and larger than allowed",
          "[calib]") {
  AssessmentScene scene;
  LackOfFit& test = scene.fit.lack_of_fit->tests[0];
  test.ratio = 1.24;  // model error 0.49 times the noise
  test.outcome = metrics::TestOutcome::failed;
  CHECK(scene.assessed().adequacy.state == AspectState::pass);
  test.ratio = 1.26;
  CHECK(scene.assessed().adequacy.state == AspectState::reservation);
  CHECK(find(scene.assessed().adequacy, "lack_of_fit")->subject == "fitted");
  scene.campaign.acceptance_bounds.model_error_to_noise = 0.6;
  CHECK(scene.assessed().adequacy.state == AspectState::pass);
  test.ratio = 100.0;
  test.outcome = metrics::TestOutcome::passed;  // not significant
  CHECK(scene.assessed().adequacy.state == AspectState::pass);
  // An estimate above the allowed error that is not significant is reported as such.
  CHECK_THAT(find(scene.assessed().adequacy, "no_lack_of_fit")->words,
             Contains("no significant model error (0.6 times the noise allowed)") &&
                 Contains("9.9 times the noise are not significantly above none"));
  test.outcome = metrics::TestOutcome::not_judged;
  CHECK(find(scene.assessed().adequacy, "lack_of_fit_not_judged") != nullptr);
  test.outcome = metrics::TestOutcome::passed;
  test.ratio = 0.2;
  CHECK(scene.assessed().adequacy.state == AspectState::pass);
  test.against = "sd";  // a stated noise that is much too large hides a lack of fit
  CHECK(find(scene.assessed().adequacy, "noise_overstated") != nullptr);
  test.ratio = 0.3;  // the residual is more than half of the noise
  CHECK(find(scene.assessed().adequacy, "noise_overstated") == nullptr);
}

TEST_CASE("adequacy: without known noise the residual speaks", "[calib]") {
  AssessmentScene scene;
  scene.fit.lack_of_fit->tests.clear();
  CHECK(scene.assessed().adequacy.state == AspectState::not_assessed);
  for (ConditionScore& score : scene.fit.conditions) {
    score.channels[0].residual_tests.emplace();
    score.channels[0].residual_tests->autocorrelation.outcome = metrics::TestOutcome::passed;
  }
  CHECK(scene.assessed().adequacy.state == AspectState::pass);
  auto& tests = *scene.fit.conditions[1].channels[0].residual_tests;
  tests.cross_correlation.emplace();
  tests.cross_correlation->outcome = metrics::TestOutcome::failed;
  tests.cross_correlation->peak = 0.3;  // 9 % of the variance
  CHECK(scene.assessed().adequacy.state == AspectState::pass);
  tests.cross_correlation->peak = -0.7;
  CHECK_THAT(find(scene.assessed().adequacy, "residual_depends_on_input")->words,
             Contains("49 % of the residual variance of position of other"));
  tests.cross_correlation.reset();
  tests.autocorrelation.outcome = metrics::TestOutcome::failed;
  CHECK(find(scene.assessed().adequacy, "noise_unknown")->state == AspectState::reservation);
}

}  // namespace rigcal::calib
