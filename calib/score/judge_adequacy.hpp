#pragma once

#include "calib/result/aspect.hpp"
#include "calib/result/fit_result.hpp"

namespace rigcal::calib {

/// Reservation where the error of the model is larger than `[acceptance] model_error_to_noise`
/// allows and significant (lack of fit, 5 % for all tests together), or where the noise is not
/// known and the residual depends on the input or on its own past.
Aspect judge_adequacy(const datasets::Campaign& campaign, const Fit& fit);

}  // namespace rigcal::calib
