#pragma once

#include <optional>
#include <set>
#include <string>

#include "calib/aspect.hpp"
#include "calib/fit.hpp"

namespace rigcal::calib {

/// Judges a finished fit or validation: the only place that does. Reports repeat what it says.
///
/// - agreement: fail where a scored condition breaks a limit or cannot be evaluated; reservation
///   between limit and warning limit, where a condition was not scored, or where its recording is
///   doubtful; not assessed without limits.
/// - validation: the same over the conditions that are not in `estimated_from`; not assessed
///   without any.
/// - adequacy: reservation where the error of the model is larger than
///   `[acceptance] model_error_to_noise` allows and significant (lack of fit, 5 % for all tests
///   together), or where the noise is not known and the residual depends on the input or on its own
///   past.
/// - parameters: pass where every estimate but nuisance parameters is identified, or cannot be told
///   from zero with an upper limit that is negligible; else reservation.
///
/// @param estimated_from  ids of conditions whose records the values in use were estimated from
/// @param parameters      of the fit whose values are validated; null: judged from `fit`
Assessment assess(const datasets::Campaign& campaign, const Fit& fit,
                  const std::set<std::string>& estimated_from, const Aspect* parameters = nullptr);

/// FAIL where agreement or validation fails, PASS where all four pass, else WARN; none where the
/// campaign has no limits.
std::optional<Verdict> verdict_of(const Assessment& assessment);

}  // namespace rigcal::calib
