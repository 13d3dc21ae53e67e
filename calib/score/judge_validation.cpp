#include "calib/score/judge_validation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "calib/score/judge_limits.hpp"

namespace rigcal::calib {
namespace {

/// Notes the predictions that the uncertainty of the estimates alone may take beyond their limit of
/// rho2, although the model is right.
void note_open_predictions(const ConditionScore& score, std::vector<Reason>& reasons) {
  for (const LimitCheck& check : score.limit_checks) {
    const auto open = score.open.find(check.channel);
    if (check.metric != "rho2" || !check.limit || open == score.open.end()) continue;
    const double expected = 1.0 - open->second.variance_fraction;
    if (expected >= *check.limit) continue;
    const std::vector<std::string>& through = open->second.through;
    reasons.push_back(reason(
        AspectState::note, "prediction_open",
        fmt::format(
            "{}: the fitted records do not determine the prediction of {}: if the model is "
            "right, an rho2 {} is expected (limit {}){}",
            score.id, datasets::info(check.channel).key,
            expected < 0.0 ? "below 0" : fmt::format("of {:.2g}", expected), *check.limit,
            through.empty() ? "" : fmt::format(", mainly due to {}", fmt::join(through, ", "))),
        score.id, {{"rho2", expected}, {"limit", *check.limit}}));
  }
}

}  // namespace

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
    for (const ConditionScore* score : independent) note_open_predictions(*score, reasons);
  }
  return aspect_of(std::move(reasons));
}

}  // namespace rigcal::calib
