#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "calib/score/acceptance.hpp"
#include "calib/score/assessment.hpp"

namespace rigcal::calib {

/// Returns a parameter of the rig that is neither fitted nor has a value.
inline FittedParameter plain_parameter(const char* key) {
  constexpr auto kPlant = model::PlantKind::load_pressure;
  return parameter_in_row(kPlant, model::parameter_index(kPlant, key), datasets::Scope::rig, {});
}

/// A result that passes all four aspects: one condition is fitted, and one is not.
struct AssessmentScene {
  datasets::Campaign campaign;
  Fit fit;
  std::set<std::string> fitted{"fitted"};

  AssessmentScene() {
    campaign.acceptance = {{datasets::Channel::position, "rho2", 0.99, 0.995}};
    add("fitted", datasets::Use::fit, 0.999);
    add("other", datasets::Use::validate, 0.998);
    fit.status = FitStatus::converged;
    FittedParameter mass = plain_parameter("mass");
    mass.value = 85.0;
    mass.fitted = true;
    mass.identifiability = Identifiability::identified;
    mass.ci95 = {84.0, 86.0};
    fit.parameters = {mass};
    for (const char* id : {"fitted", "other"}) {
      LackOfFit test;
      test.condition = id;
      test.ratio = 1.0;
      test.outcome = metrics::TestOutcome::passed;
      test.against = "repeats";
      fit.lack_of_fit->tests.push_back(test);
    }
  }

  void add(const std::string& id, datasets::Use use, double rho2) {
    datasets::Condition condition;
    condition.id = id;
    condition.use = use;
    campaign.conditions.push_back(condition);
    ConditionScore score;
    score.id = id;
    score.use = use;
    ChannelScore channel;
    channel.channel = datasets::Channel::position;
    channel.metrics.rho2 = rho2;
    score.channels = {channel};
    judge(campaign.acceptance, campaign.acceptance_bounds.decision, score);
    fit.conditions.push_back(score);
  }

  void rejudge(std::size_t condition, double rho2) {
    ConditionScore& score = fit.conditions.at(condition);
    score.channels[0].metrics.rho2 = rho2;
    score.limit_checks.clear();
    score.reasons.clear();
    score.verdict.reset();
    judge(campaign.acceptance, campaign.acceptance_bounds.decision, score);
  }

  Assessment assessed() const { return assess(campaign, fit, fitted); }
  std::optional<Verdict> verdict() const { return verdict_of(assessed()); }
};

/// Returns the reason with this code, or null if there is none.
inline const Reason* find(const Aspect& aspect, std::string_view code) {
  for (const Reason& reason : aspect.reasons) {
    if (reason.code == code) return &reason;
  }
  return nullptr;
}

}  // namespace rigcal::calib
