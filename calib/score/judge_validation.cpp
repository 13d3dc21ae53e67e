#include "calib/score/judge_validation.hpp"

#include "calib/score/judge_limits.hpp"

namespace rigcal::calib {

Aspect judge_validation(const datasets::Campaign& campaign, const Fit& fit,
                        const std::set<std::string>& estimated_from) {
  std::vector<Reason> reasons;
  std::vector<const ConditionScore*> independent;
  for (const ConditionScore& score : fit.conditions) {
    if (!estimated_from.contains(score.id)) independent.push_back(&score);
  }
  if (independent.empty()) {
    std::string words =
        "not assessed: every condition with a score was also used to estimate the values";
    if (fit.cross_validation)
      words += "; see the cross-validation, which leaves out one after the other";
    reasons.push_back(
        reason(AspectState::not_assessed, "no_validation", words, {}, {{"conditions", 0.0}}));
  } else if (!has_limits(campaign, fit)) {
    reasons.push_back(no_limits());
  } else {
    judge_limits(independent, reasons);
    if (reasons.empty()) {
      reasons.push_back(reason(AspectState::not_assessed, "not_scored",
                               "no condition of the validation has a limit"));
    }
  }
  return aspect_of(std::move(reasons));
}

}  // namespace rigcal::calib
