#include <catch2/catch.hpp>

#include "calib/score/judges.hpp"
#include "tests/calib/assessment_scene.hpp"

namespace rigcal::calib {
namespace {

FittedParameter bounded_leak(double limit) {
  FittedParameter leak = plain_parameter("leakage_coefficient");
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

TEST_CASE("parameters: each is identified, or negligible", "[calib]") {
  AssessmentScene scene;
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
  SECTION("a model error that nothing shows is a note, one that the residuals show a reservation") {
    scene.fit.considered.emplace();
    FittedParameter& mass = scene.fit.parameters[0];
    mass.ci95 = {83.0, 87.0};
    mass.moved_by_unseen = 1.9;
    CHECK(find(scene.assessed().parameters, "unseen_error") == nullptr);
    mass.moved_by_unseen = 2.1;
    CHECK(find(scene.assessed().parameters, "unseen_error")->subject == "mass_kg");
    CHECK(scene.assessed().parameters.state == AspectState::pass);
    mass.moved_by_unexplained = 1.9;
    CHECK(scene.assessed().parameters.state == AspectState::pass);
    mass.moved_by_unexplained = 2.1;
    CHECK(find(scene.assessed().parameters, "unexplained_error")->subject == "mass_kg");
    mass.nuisance = true;
    CHECK(find(scene.assessed().parameters, "unexplained_error") == nullptr);
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
    CHECK(find(scene.assessed().parameters, "not_converged") != nullptr);
    CHECK(find(scene.assessed().parameters, "identified") == nullptr);
  }
  SECTION("known values that are taken as exact are named, and change nothing") {
    const auto add = [&](const char* key) {
      return scene.fit.parameters.emplace_back(plain_parameter(key)).index;
    };
    add("piston_area");
    add("leakage_smoothing");  // a numerical parameter, not a property of the rig
    add("initial_position");
    datasets::ParameterSetting supply;
    supply.index = add("supply_pressure");
    CHECK_THAT(find(scene.assessed().parameters, "exact_values")->words,
               Catch::Contains("2 known values taken as exact: piston_area, supply_pressure"));
    CHECK(find(scene.assessed().parameters, "exact_values")->state == AspectState::note);
    CHECK(scene.verdict() == Verdict::pass);
    supply.prior = datasets::Prior{6.2e6, 1e4};
    scene.campaign.parameters = {supply};
    CHECK_THAT(find(scene.assessed().parameters, "exact_values")->words,
               Catch::Contains("1 known value taken as exact: piston_area"));
  }
  SECTION("those of the fit whose values are validated") {
    Aspect earlier;
    earlier.state = AspectState::reservation;
    CHECK(verdict_of(assess(scene.campaign, scene.fit, {}, &earlier)) == Verdict::warn);
  }
}

TEST_CASE("parameters: draws of a posterior that cannot be believed are a reservation", "[calib]") {
  AssessmentScene scene;
  Posterior& found = scene.fit.posterior.emplace();
  found.chains = 4;
  found.draws = 1000;
  found.r_hat = 1.01;
  found.worst = "mass_kg";
  CHECK(scene.assessed().parameters.state == AspectState::pass);
  SECTION("chains that disagree") {
    found.r_hat = 1.011;
    const Aspect parameters = scene.assessed().parameters;
    REQUIRE(find(parameters, "posterior_not_mixed") != nullptr);
    CHECK(find(parameters, "posterior_not_mixed")->subject == "mass_kg");
    CHECK(parameters.state == AspectState::reservation);
  }
  SECTION("divergences") {
    found.diverged = 1;
    CHECK(find(scene.assessed().parameters, "posterior_divergences") != nullptr);
    CHECK(scene.verdict() == Verdict::warn);
  }
  SECTION("no draws, nothing to believe") {
    found.draws = 0;
    found.r_hat = 2.0;
    CHECK(scene.assessed().parameters.state == AspectState::pass);
  }
}

}  // namespace rigcal::calib
