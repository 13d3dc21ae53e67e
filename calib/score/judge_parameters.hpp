#pragma once

#include "calib/result/aspect.hpp"
#include "calib/result/fit_result.hpp"

namespace rigcal::calib {

/// Passes if every estimate except nuisance parameters is either identified, or indistinguishable
/// from zero with a negligible upper limit. Otherwise expresses a reservation.
Aspect judge_parameters(const datasets::Campaign& campaign, const Fit& fit);

}  // namespace rigcal::calib
