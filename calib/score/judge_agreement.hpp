#pragma once

#include "calib/result/aspect.hpp"
#include "calib/result/fit_result.hpp"

namespace rigcal::calib {

/// Fail where a scored condition breaks a limit or cannot be evaluated; reservation between limit
/// and warning limit, where a condition was not scored, or where its recording is doubtful; not
/// assessed without limits, where the least agreement is named.
Aspect judge_agreement(const datasets::Campaign& campaign, const Fit& fit);

}  // namespace rigcal::calib
