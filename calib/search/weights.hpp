#pragma once

#include <string>
#include <vector>

#include "calib/search/multi_start.hpp"

namespace rigcal::calib {

/// Estimates the noise of channels for which neither repeats nor the campaign give it. It is the
/// residual of the fit, pooled over the conditions in which the noise is unknown. The fit is solved
/// again from the optimum until no standard deviation changes by more than a tenth. The tolerance
/// of the simulations follows, unless the campaign fixes it. An estimate is never below
/// Problem::least_sd(), so that no fit follows the errors of its own simulations; a warning says
/// so. If other channels have known noise, this sets the relative weight of the channels correctly;
/// model errors then count as noise, which a warning says, too.
///
/// @param problem  its estimated standard deviations, and its tolerance, are changed
/// @param found    optimum and result are those of the last round
void estimate_weights(Problem& problem, Evaluator& evaluator, const FitOptions& options,
                      MultiStart& found, std::vector<std::string>& warnings);

}  // namespace rigcal::calib
