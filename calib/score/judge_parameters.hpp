#pragma once

#include "calib/result/aspect.hpp"
#include "calib/result/fit_result.hpp"

namespace rigcal::calib {

/// Pass where every estimate but nuisance parameters is identified, or cannot be told from zero
/// with an upper limit that is negligible; else reservation.
Aspect judge_parameters(const datasets::Campaign& campaign, const Fit& fit);

}  // namespace rigcal::calib
