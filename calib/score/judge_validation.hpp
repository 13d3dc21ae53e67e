#pragma once

#include <set>
#include <string>

#include "calib/result/aspect.hpp"
#include "calib/result/fit_result.hpp"
#include "calib/result/origin.hpp"

namespace rigcal::calib {

/// Judges the conditions that are not in `estimated_from` against their limits. Validation is not
/// assessed if there are no such conditions.
Aspect judge_validation(const datasets::Campaign& campaign, const Fit& fit,
                        const std::set<std::string>& estimated_from);

}  // namespace rigcal::calib
