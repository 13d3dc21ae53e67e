#pragma once

#include <string>
#include <vector>

#include "calib/search/multi_start.hpp"

namespace rigcal::calib {

/// Estimates the noise of channels for which neither repeats nor the campaign specify it. The
/// estimate is the residual of the fit, pooled over the conditions in which the noise is unknown.
/// The fit is repeated from the optimum until no standard deviation changes by more than a tenth.
/// The simulation tolerance is adapted, unless the campaign fixes it. An estimate is never below
/// Problem::least_sd(), so that no fit follows the errors of its own simulations; a warning says
/// so. If other channels have known noise, the relative weight of the channels is then correct, but
/// model errors count as noise; a warning says this, too.
///
/// @param problem  its estimated standard deviations and its tolerance are changed
/// @param found    receives the optimum and the result of the last round
void estimate_weights(Problem& problem, Evaluator& evaluator, const FitOptions& options,
                      MultiStart& found, std::vector<std::string>& warnings);

}  // namespace rigcal::calib
