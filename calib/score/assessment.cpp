#include "calib/score/assessment.hpp"

#include "calib/score/judges.hpp"

namespace rigcal::calib {

Assessment assess(const datasets::Campaign& campaign, const Fit& fit,
                  const std::set<std::string>& estimated_from, const Aspect* parameters) {
  return {judge_agreement(campaign, fit), judge_validation(campaign, fit, estimated_from),
          judge_adequacy(campaign, fit),
          parameters != nullptr ? *parameters : judge_parameters(campaign, fit)};
}

std::optional<Verdict> verdict_of(const Assessment& assessment) {
  const auto& [agreement, validation, adequacy, parameters] = assessment;
  if (agreement.state == AspectState::not_assessed) return std::nullopt;
  if (agreement.state == AspectState::fail || validation.state == AspectState::fail)
    return Verdict::fail;
  const bool all = validation.state == AspectState::pass && adequacy.state == AspectState::pass &&
                   parameters.state == AspectState::pass && agreement.state == AspectState::pass;
  return all ? Verdict::pass : Verdict::warn;
}

bool has_range_of_validity(AspectState agreement, AspectState validation) {
  const bool validated = validation == AspectState::pass || validation == AspectState::reservation;
  return validated && agreement != AspectState::fail;
}

}  // namespace rigcal::calib
