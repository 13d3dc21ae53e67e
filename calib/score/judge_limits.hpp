#pragma once

#include <string>
#include <vector>

#include "calib/result/aspect.hpp"
#include "calib/result/fit_result.hpp"

namespace rigcal::calib {

/// Whether the campaign or a condition has limits.
bool has_limits(const datasets::Campaign& campaign, const Fit& fit);

/// The reason to give if there are no limits.
Reason no_limits();

/// Appends the verdicts on the limits of some conditions, the worst first: one reason for each
/// condition that breaks a limit or is not scored, and a common one for all that keep their limits.
void judge_limits(const std::vector<const ConditionScore*>& scores, std::vector<Reason>& reasons);

/// "1 condition", "3 conditions".
std::string conditions_text(std::size_t count);

}  // namespace rigcal::calib
