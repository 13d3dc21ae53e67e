#include "calib/assessment.hpp"

#include <catch2/catch.hpp>

#include "calib/acceptance.hpp"

namespace rigcal::calib {
namespace {

using Catch::Contains;
using datasets::Channel;
using datasets::Use;

/// A result that passes all four: one condition fitted, one not.
struct Scene {
  datasets::Campaign campaign;
  Fit fit;
  std::set<std::string> fitted{"fitted"};

  Scene() {
    campaign.acceptance = {{Channel::position, "rho2", 0.99, 0.995}};
    add("fitted", Use::fit, 0.999);
    add("other", Use::validate, 0.998);
    fit.status = FitStatus::converged;
    FittedParameter mass;
    mass.index = model::parameter_index(model::PlantKind::load_pressure, "mass");
    mass.value = 85.0;
    mass.fitted = true;
    mass.ci95 = {84.0, 86.0};
    fit.parameters = {mass};
    for (const char* id : {"fitted", "other"}) {
      LackOfFit test;
      test.condition = id;
      test.ratio = 1.0;
      test.outcome = metrics::TestOutcome::passed;
      test.by_repeats = true;
      fit.lack_of_fit.push_back(test);
    }
  }

  void add(const std::string& id, Use use, double rho2) {
    datasets::Condition condition;
    condition.id = id;
    condition.use = use;
    campaign.conditions.push_back(condition);
    ConditionScore score;
    score.id = id;
    score.use = use;
    ChannelScore channel;
    channel.channel = Channel::position;
    channel.agreement.emplace();
    channel.agreement->rho2 = rho2;
    score.channels = {channel};
    judge(campaign.acceptance, score);
    fit.conditions.push_back(score);
  }

  void rejudge(std::size_t condition, double rho2) {
    ConditionScore& score = fit.conditions.at(condition);
    score.channels[0].agreement->rho2 = rho2;
    score.checks.clear();
    score.reasons.clear();
    score.verdict.reset();
    judge(campaign.acceptance, score);
  }

  Assessment assessed() const { return assess(campaign, fit, fitted); }
  std::optional<Verdict> verdict() const { return verdict_of(assessed()); }
};

/// The reason of this code, or none.
const Reason* find(const Aspect& aspect, std::string_view code) {
  for (const Reason& reason : aspect.reasons) {
    if (reason.code == code) return &reason;
  }
  return nullptr;
}

FittedParameter bounded_leak(double limit) {
  FittedParameter leak;
  leak.index = model::parameter_index(model::PlantKind::load_pressure, "leakage_coefficient");
  leak.fitted = true;
  leak.scope = datasets::Scope::leak_level;
  leak.level = "none";
  leak.ci95 = {0.0, limit};
  leak.at_bound = true;
  leak.identifiability = Identifiability::bounded;
  leak.reason = "not significantly different from zero";
  return leak;
}

}  // namespace

TEST_CASE("assessment: PASS needs all four aspects", "[calib]") {
  CHECK(Scene().verdict() == Verdict::pass);
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

TEST_CASE("assessment: a broken limit fails, of the validation in both aspects", "[calib]") {
  Scene scene;
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

TEST_CASE("assessment: a limit that cannot be evaluated fails", "[calib]") {
  Scene scene;
  scene.fit.conditions[0].channels[0].agreement.reset();
  scene.fit.conditions[0].checks.clear();
  judge(scene.campaign.acceptance, scene.fit.conditions[0]);
  CHECK(scene.verdict() == Verdict::fail);
  CHECK(find(scene.assessed().agreement, "limit_not_evaluable") != nullptr);
  Scene unrecorded;
  unrecorded.campaign.acceptance.push_back({Channel::pressure_a, "rho2", 0.9, std::nullopt});
  CHECK(unrecorded.verdict() == Verdict::fail);
  CHECK_THAT(find(unrecorded.assessed().agreement, "limit_not_evaluable")->words,
             Contains("no condition recorded pressure_a"));
}

TEST_CASE("assessment: what was fitted does not validate", "[calib]") {
  Scene scene;
  scene.fitted = {"fitted", "other"};
  CHECK(scene.assessed().validation.state == AspectState::not_assessed);
  CHECK(find(scene.assessed().validation, "no_validation") != nullptr);
  CHECK(scene.verdict() == Verdict::warn);
  scene.fitted = {};
  CHECK(find(scene.assessed().validation, "limits_kept")->numbers.front().second == 2.0);
}

TEST_CASE("assessment: lack of fit counts where it is significant and larger than allowed",
          "[calib]") {
  Scene scene;
  LackOfFit& test = scene.fit.lack_of_fit[0];
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
  test.outcome = metrics::TestOutcome::not_judged;
  CHECK(find(scene.assessed().adequacy, "lack_of_fit_not_judged") != nullptr);
  test.outcome = metrics::TestOutcome::passed;
  test.ratio = 0.2;
  CHECK(scene.assessed().adequacy.state == AspectState::pass);
  test.by_repeats = false;  // a stated noise that is far too large hides a lack of fit
  CHECK(find(scene.assessed().adequacy, "noise_overstated") != nullptr);
  test.ratio = 0.3;  // a residual of more than half of the noise
  CHECK(find(scene.assessed().adequacy, "noise_overstated") == nullptr);
}

TEST_CASE("assessment: without known noise the residual speaks", "[calib]") {
  Scene scene;
  scene.fit.lack_of_fit.clear();
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

TEST_CASE("assessment: parameters", "[calib]") {
  Scene scene;
  SECTION("weak, not identifiable, at an active bound") {
    for (const auto& [grade, code] :
         {std::pair{Identifiability::weak, "weak"},
          std::pair{Identifiability::not_identifiable, "not_identifiable"}}) {
      scene.fit.parameters[0].identifiability = grade;
      CHECK(find(scene.assessed().parameters, code)->subject == "mass_kg");
      CHECK(scene.verdict() == Verdict::warn);
    }
    scene.fit.parameters[0].identifiability = Identifiability::identified;
    scene.fit.parameters[0].at_bound = true;
    CHECK(find(scene.assessed().parameters, "active_bound") != nullptr);
  }
  SECTION("nuisance parameters do not count") {
    scene.fit.parameters[0].identifiability = Identifiability::not_identifiable;
    scene.fit.parameters[0].nuisance = true;
    CHECK(scene.assessed().parameters.state == AspectState::pass);
  }
  SECTION("bounded: negligible beside other levels, or as stated") {
    scene.fit.parameters.push_back(bounded_leak(0.01));
    CHECK(scene.assessed().parameters.state == AspectState::reservation);
    scene.campaign.acceptance_bounds.negligible[scene.fit.parameters[1].index] = 0.01;
    CHECK(scene.assessed().parameters.state == AspectState::pass);
    scene.campaign.acceptance_bounds.negligible[scene.fit.parameters[1].index] = 0.009;
    CHECK(scene.assessed().parameters.state == AspectState::reservation);
    scene.campaign.acceptance_bounds.negligible.clear();
    FittedParameter leak = bounded_leak(0.6);
    leak.level = "open";
    leak.value = 0.05;
    leak.at_bound = false;
    leak.identifiability = Identifiability::identified;
    scene.fit.parameters.push_back(leak);
    CHECK(scene.assessed().parameters.state == AspectState::pass);
    scene.fit.parameters[2].value = 0.04;
    CHECK(scene.assessed().parameters.state == AspectState::reservation);
  }
  SECTION("bounded on both sides of zero: the farther end counts") {
    FittedParameter leak = bounded_leak(0.001);
    leak.ci95 = {-0.1, 0.001};
    scene.fit.parameters.push_back(leak);
    scene.campaign.acceptance_bounds.negligible[leak.index] = 0.05;
    CHECK(scene.assessed().parameters.state == AspectState::reservation);
  }
  SECTION("a point that one of several starts found") {
    scene.fit.starts.resize(3);
    scene.fit.basins = {{1.0, {2}, {}}, {2.0, {1, 3}, {}}};
    CHECK(find(scene.assessed().parameters, "found_once") != nullptr);
    scene.fit.basins = {{1.0, {2, 1}, {}}, {2.0, {3}, {}}};
    CHECK(find(scene.assessed().parameters, "found_once") == nullptr);
  }
  SECTION("a fit that did not converge never passes") {
    scene.fit.status = FitStatus::stopped;
    CHECK(scene.verdict() == Verdict::warn);
  }
  SECTION("those of the fit whose values are validated") {
    Aspect earlier;
    earlier.state = AspectState::reservation;
    CHECK(verdict_of(assess(scene.campaign, scene.fit, {}, &earlier)) == Verdict::warn);
  }
}

TEST_CASE("assessment: a doubtful recording and a condition that was not scored are reservations",
          "[calib]") {
  Scene scene;
  scene.fit.conditions[0].data_warnings = {"40 spikes"};
  CHECK(find(scene.assessed().agreement, "recording_doubtful")->subject == "fitted");
  CHECK(scene.verdict() == Verdict::warn);
  scene.fit.conditions[0].data_warnings.clear();
  ConditionScore& other = scene.fit.conditions[1];
  other.checks.clear();
  other.verdict.reset();
  other.not_scored = "stopped on request";
  CHECK(find(scene.assessed().validation, "not_scored")->subject == "other");
  CHECK(scene.verdict() == Verdict::warn);
}

TEST_CASE("assessment: without limits there is no verdict, but poor agreement is named",
          "[calib]") {
  Scene scene;
  scene.campaign.acceptance.clear();
  for (std::size_t i = 0; i < 2; ++i) scene.rejudge(i, 0.95);
  CHECK_FALSE(scene.verdict().has_value());
  CHECK(find(scene.assessed().agreement, "least_agreement") != nullptr);
  scene.rejudge(1, 0.5);
  CHECK(find(scene.assessed().agreement, "poor_agreement")->subject == "other");
}

}  // namespace rigcal::calib
