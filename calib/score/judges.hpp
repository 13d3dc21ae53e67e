#pragma once

#include <set>
#include <string>

#include "calib/result/aspect.hpp"
#include "calib/result/fit_result.hpp"

// The judges of the four aspects.

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

/// Expresses a reservation if the model error is significant (lack of fit, 5 % for all tests
/// together) and larger than `[acceptance] model_error_to_noise` allows. If the noise is unknown,
/// expresses a reservation if the residual depends on the input or on its own past.
Aspect judge_adequacy(const datasets::Campaign& campaign, const Fit& fit);

/// Passes if every estimate except nuisance parameters is either identified, or indistinguishable
/// from zero with a negligible upper limit. Otherwise expresses a reservation.
Aspect judge_parameters(const datasets::Campaign& campaign, const Fit& fit);

}  // namespace rigcal::calib
