#pragma once

#include <string>
#include <vector>

#include "calib/result/aspect.hpp"
#include "calib/result/fit_result.hpp"

namespace rigcal::calib {

/// Returns true if the campaign or one of its conditions has limits.
bool has_limits(const datasets::Campaign& campaign, const Fit& fit);

/// Returns the reason to give if there are no limits.
Reason no_limits();

/// Appends reasons with the verdicts on the limits of several conditions, the worst first. Each
/// condition that breaks a limit or is not scored has its own reason; all conditions that keep
/// their limits share one.
void judge_limits(const std::vector<const ConditionScore*>& scores, std::vector<Reason>& reasons);

/// Returns, for example, "1 condition" or "3 conditions".
std::string conditions_text(std::size_t count);

}  // namespace rigcal::calib
