#pragma once

#include <set>
#include <string>

#include "calib/result/aspect.hpp"
#include "calib/result/fit_result.hpp"

namespace rigcal::calib {

/// Fails if a scored condition breaks a limit or cannot be evaluated. Expresses a reservation if a
/// value is between the limit and the warning limit, if a condition was not scored, or if a
/// recording is doubtful. Without limits, agreement is not assessed, and the reason names the
/// signal that agrees least.
Aspect judge_agreement(const datasets::Campaign& campaign, const Fit& fit);

/// Judges the conditions that are not in `estimated_from` against their limits. Validation is not
/// assessed if there are no such conditions.
Aspect judge_validation(const datasets::Campaign& campaign, const Fit& fit,
                        const std::set<std::string>& estimated_from);

}  // namespace rigcal::calib
