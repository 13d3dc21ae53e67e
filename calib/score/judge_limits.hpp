#pragma once

#include <string>
#include <vector>

#include "calib/result/aspect.hpp"
#include "calib/result/fit_result.hpp"

namespace rigcal::calib {

/// Whether there are limits, of the campaign or of a condition.
bool has_limits(const datasets::Campaign& campaign, const Fit& fit);

/// The reason where it cannot.
Reason no_limits();

/// Appends the verdicts on the limits of some conditions, the worst first: one reason for each
/// condition that breaks its limits or is not scored, and one for all that keep them.
void judge_limits(const std::vector<const ConditionScore*>& scores, std::vector<Reason>& reasons);

/// "1 condition", "3 conditions".
std::string conditions_text(std::size_t count);

}  // namespace rigcal::calib
