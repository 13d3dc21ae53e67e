#pragma once

#include <string>
#include <vector>

#include "calib/result/aspect.hpp"
#include "calib/result/fit_result.hpp"

namespace rigcal::calib {

/// Whether anything can be judged: the campaign or a condition of its own has limits.
bool has_limits(const datasets::Campaign& campaign, const Fit& fit);

/// The reason where it cannot.
Reason no_limits();

/// Appends what the limits say of some conditions, the furthest beyond them first: one reason for
/// each that does not keep its limits or is not scored, and one for all that do.
void judge_limits(const std::vector<const ConditionScore*>& scores, std::vector<Reason>& reasons);

/// "1 condition", "3 conditions".
std::string conditions_text(std::size_t count);

}  // namespace rigcal::calib
