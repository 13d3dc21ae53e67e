#include <catch2/catch.hpp>

#include "calib/score/judges.hpp"
#include "tests/calib/assessment_scene.hpp"

namespace rigcal::calib {
namespace {

using Catch::Contains;
using datasets::Channel;

}  // namespace

TEST_CASE("agreement: a broken limit fails, of the validation in both aspects", "[calib]") {
  AssessmentScene scene;
  scene.rejudge(0, 0.98);
  CHECK(scene.assessed().agreement.state == AspectState::fail);
  CHECK(scene.assessed().validation.state == AspectState::pass);
  CHECK(scene.verdict() == Verdict::fail);
  scene.rejudge(0, 0.999);
  scene.rejudge(1, 0.98);
  CHECK(scene.assessed().agreement.state == AspectState::fail);
  CHECK(scene.assessed().validation.state == AspectState::fail);
  CHECK(find(scene.assessed().validation, "limit_broken")->subject == "other");
  scene.rejudge(1, 0.992);
  CHECK(scene.assessed().validation.state == AspectState::reservation);
  CHECK(scene.verdict() == Verdict::warn);
}

TEST_CASE("agreement: a limit that is kept within the guard band alone is a reservation",
          "[calib]") {
  AssessmentScene scene;
  scene.campaign.acceptance_bounds.decision = datasets::DecisionRule::guard_band;
  for (std::size_t i = 0; i < 2; ++i) {
    scene.fit.conditions[i].channels[0].expanded_uncertainty.emplace();
    scene.rejudge(i, 0.999);
  }
  CHECK(scene.verdict() == Verdict::pass);
  scene.fit.conditions[1].channels[0].expanded_uncertainty->rho2 = 0.02;
  scene.rejudge(1, 0.999);
  CHECK(scene.verdict() == Verdict::warn);
  const Assessment assessed = scene.assessed();
  const Reason* reason = find(assessed.agreement, "guard_band");
  REQUIRE(reason != nullptr);
  CHECK(reason->subject == "other");
  scene.rejudge(1, 0.992);  // between limit and warning limit
  CHECK(find(scene.assessed().agreement, "limit_near") != nullptr);
}

TEST_CASE("agreement: a limit that cannot be evaluated fails", "[calib]") {
  AssessmentScene scene;
  scene.fit.conditions[0].channels[0].metrics = ChannelMetrics{};
  scene.fit.conditions[0].limit_checks.clear();
  judge(scene.campaign.acceptance, datasets::DecisionRule::simple, scene.fit.conditions[0]);
  CHECK(scene.verdict() == Verdict::fail);
  CHECK(find(scene.assessed().agreement, "limit_not_evaluable") != nullptr);
  AssessmentScene unrecorded;
  unrecorded.campaign.acceptance.push_back({Channel::pressure_a, "rho2", 0.9, std::nullopt});
  CHECK(unrecorded.verdict() == Verdict::fail);
  CHECK_THAT(find(unrecorded.assessed().agreement, "limit_not_evaluable")->words,
             Contains("no condition recorded pressure_a"));
}

TEST_CASE("agreement: a doubtful recording and a condition that was not scored are reservations",
          "[calib]") {
  AssessmentScene scene;
  scene.fit.conditions[0].warnings = {"40 spikes"};
  CHECK(find(scene.assessed().agreement, "recording_doubtful")->subject == "fitted");
  CHECK(scene.verdict() == Verdict::warn);
  scene.fit.conditions[0].warnings.clear();
  ConditionScore& other = scene.fit.conditions[1];
  other.limit_checks.clear();
  other.verdict.reset();
  other.not_scored = "stopped on request";
  CHECK(find(scene.assessed().validation, "not_scored")->subject == "other");
  CHECK(scene.verdict() == Verdict::warn);
}

TEST_CASE("agreement: a channel without a limit is a reservation, unless it may have none",
          "[calib]") {
  AssessmentScene scene;
  ChannelScore pressure;
  pressure.channel = Channel::pressure_a;
  pressure.metrics.rho2 = -15.0;
  ConditionScore& other = scene.fit.conditions[1];
  other.channels.push_back(pressure);
  scene.rejudge(1, 0.998);
  const Assessment assessed = scene.assessed();
  const Reason* told = find(assessed.agreement, "not_judged");
  REQUIRE(told != nullptr);
  CHECK(assessed.agreement.state == AspectState::reservation);
  CHECK(told->subject == "other");
  CHECK_THAT(told->words, Contains("pressure_a") && Contains("-15"));
  CHECK(other.verdict_of(Channel::position) == Verdict::pass);
  CHECK_FALSE(other.verdict_of(Channel::pressure_a).has_value());

  const auto stated = [&] {
    const Assessment now = scene.assessed();
    CHECK(find(now.agreement, "not_judged") == nullptr);
    const Reason* note = find(now.agreement, "not_judged_as_stated");
    REQUIRE(note != nullptr);
    CHECK(note->state == AspectState::note);
    CHECK(now.agreement.state == AspectState::pass);
  };
  scene.campaign.acceptance_bounds.not_judged = {Channel::pressure_a};
  stated();
  scene.campaign.acceptance_bounds.not_judged.clear();
  scene.campaign.conditions[1].not_judged = {Channel::pressure_a};
  stated();
  scene.campaign.conditions[1].not_judged.clear();
  scene.campaign.conditions[0].not_judged = {Channel::pressure_a};  // a different condition
  CHECK(scene.assessed().agreement.state == AspectState::reservation);
}

TEST_CASE("agreement: a sensor that was overdue on the day of the test is a reservation",
          "[calib]") {
  AssessmentScene scene;
  scene.campaign.report.sensors = {
      datasets::ReportSettings::Fields{{"channel", "position"}, {"due", "2026-01-31"}}};
  CHECK(scene.verdict() == Verdict::pass);
  scene.campaign.conditions[1].date = "2026-01-31";
  CHECK(scene.verdict() == Verdict::pass);
  scene.campaign.conditions[1].date = "2026-02-01T09:00:00";
  CHECK(scene.verdict() == Verdict::warn);
  CHECK_THAT(find(scene.assessed().agreement, "sensor_overdue")->words,
             Contains("other was tested on 2026-02-01"));
}

TEST_CASE("agreement: a limit that is kept is never used up", "[calib]") {
  CHECK(tolerance_used_text(0.37) == "37 %");
  CHECK(tolerance_used_text(0.996) == "99.6 %");
  CHECK(tolerance_used_text(0.99996) == "99.996 %");
  CHECK(tolerance_used_text(1.0 - 1e-9) == "just below 100 %");
  CHECK(tolerance_used_text(1.0) == "100 %");
  CHECK(tolerance_used_text(1.004) == "100.4 %");
  CHECK(tolerance_used_text(2.2) == "220 %");
  CHECK(tolerance_used_text(11.0) == "over 1000 %");
}

TEST_CASE("agreement: without limits there is no verdict, but poor agreement is named", "[calib]") {
  AssessmentScene scene;
  scene.campaign.acceptance.clear();
  for (std::size_t i = 0; i < 2; ++i) scene.rejudge(i, 0.95);
  CHECK_FALSE(scene.verdict().has_value());
  CHECK(find(scene.assessed().agreement, "least_agreement") != nullptr);
  scene.rejudge(1, 0.5);
  CHECK(find(scene.assessed().agreement, "poor_agreement")->subject == "other");
}

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
