#pragma once

#include "calib/result/condition_score.hpp"

namespace rigcal::calib {

/// Sets checks, verdict and reasons of a score by the campaign's limits: FAIL beyond a limit and
/// where a limited metric does not exist, WARN between the limit and the warning limit. A channel
/// that the condition did not record is not judged. Without any limit for its channels there is no
/// verdict; a condition that could not be simulated fails.
void judge(const std::vector<datasets::AcceptanceLimit>& limits, ConditionScore& score);

}  // namespace rigcal::calib
