#pragma once

#include "report/store/json.hpp"

namespace rigcal::report {

/// What the residuals of each channel of each condition of a fit were divided by: list of
/// `condition`, `channel`, `samples`, `sd` (SI; null where the fit estimated it from its own
/// residual), `rms` of the residual.
Json weights_json(const Result& result);

}  // namespace rigcal::report
