#pragma once

#include <string>
#include <vector>

#include "calib/search/multi_start.hpp"

namespace rigcal::calib {

/// Estimates the noise of channels for which neither the repeats nor the campaign specify it. The
/// estimate is the RMS residual of the fit, pooled over the conditions in which the noise is
/// unknown. The fit is repeated from the optimum until no standard deviation changes by more than a
/// tenth. The simulation tolerance is adapted, unless the campaign fixes it. An estimate is never
/// below Problem::least_sd(), so that no fit follows the errors of its own simulations; a warning
/// is added if this limit applies. If other channels have known noise, the relative weights of the
/// channels are correct, but model errors count as noise; this also adds a warning.
///
/// @param problem  receives the estimated standard deviations and the adapted tolerance
/// @param found    receives the optimum and the result of the last round
void estimate_weights(Problem& problem, Evaluator& evaluator, const FitOptions& options,
                      MultiStart& found, std::vector<std::string>& warnings);

}  // namespace rigcal::calib
