#pragma once

#include "calib/result/aspect.hpp"
#include "calib/result/fit_result.hpp"

namespace rigcal::calib {

/// Fails if a scored condition breaks a limit or cannot be evaluated. Makes a reservation for a
/// value between limit and warning limit, for a condition that was not scored, and for a doubtful
/// recording. Without limits agreement is not assessed, and the reason names the lowest agreement.
Aspect judge_agreement(const datasets::Campaign& campaign, const Fit& fit);

}  // namespace rigcal::calib
