#pragma once

#include <set>
#include <string>

#include "calib/result/aspect.hpp"
#include "calib/result/fit_result.hpp"
#include "calib/result/origin.hpp"

namespace rigcal::calib {

/// What the limits say of the conditions that are not in `estimated_from`; not assessed without
/// any.
Aspect judge_validation(const datasets::Campaign& campaign, const Fit& fit,
                        const std::set<std::string>& estimated_from);

}  // namespace rigcal::calib
