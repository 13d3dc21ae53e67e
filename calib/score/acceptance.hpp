#pragma once

#include "calib/result/condition_score.hpp"

namespace rigcal::calib {

/// Sets checks, verdict and reasons of a score by the campaign's limits: FAIL beyond a limit and
/// where a limited metric does not exist, WARN between the limit and the warning limit. A channel
/// that the condition did not record is not judged. By the rule of the guard band, WARN too where a
/// limit is not kept by more than the score's expanded uncertainty, or where that is not known.
/// Without any limit for its channels there is no verdict; a condition that could not be simulated
/// fails.
void judge(const std::vector<datasets::AcceptanceLimit>& limits, datasets::DecisionRule rule,
           ConditionScore& score);

}  // namespace rigcal::calib
