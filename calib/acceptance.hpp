#pragma once

#include "calib/fit.hpp"

namespace rigcal::calib {

/// Sets verdict and reasons of a score by the campaign's limits: FAIL beyond a limit, WARN between
/// it and the warning limit, and where a limited metric does not exist. A channel that the
/// condition did not record is not judged. Without any limit for its channels there is no verdict;
/// a condition that could not be simulated fails.
void judge(const std::vector<datasets::AcceptanceLimit>& limits, ConditionScore& score);

/// The worst verdict; empty if no condition has one.
std::optional<Verdict> worst(const std::vector<ConditionScore>& scores);

}  // namespace rigcal::calib
