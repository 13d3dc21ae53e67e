#pragma once

#include "calib/result/aspect.hpp"
#include "calib/result/fit_result.hpp"

namespace rigcal::calib {

/// Expresses a reservation if the model error is significant (lack of fit, 5 % for all tests
/// together) and larger than `[acceptance] model_error_to_noise` allows. If the noise is unknown,
/// expresses a reservation if the residual depends on the input or on its own past.
Aspect judge_adequacy(const datasets::Campaign& campaign, const Fit& fit);

}  // namespace rigcal::calib
