#pragma once

#include <string>
#include <string_view>

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

/// Name of a decision rule on certificates: "simple acceptance", "guard band".
std::string_view words_of(datasets::DecisionRule rule);

/// Part of a tolerance that is used, rounded so that a limit that is kept never looks exhausted:
/// "37 %", "99.96 %", "over 1000 %".
///
/// @param used  fraction of the tolerance; above 1 the limit is broken
std::string tolerance_used_text(double used);

}  // namespace rigcal::calib
