#pragma once

#include <string>
#include <vector>

#include "calib/search/multi_start.hpp"

namespace rigcal::calib {

/// Where neither repeats nor the campaign tell the noise of a channel: takes it from the residuals
/// of the fit, pooled over the conditions in which it is unknown, solves again from the optimum,
/// and repeats until no standard deviation moves by more than a tenth. The tolerance of the
/// simulations follows, unless the campaign fixes it. Not below Problem::least_sd(), so that no fit
/// chases the errors of its own simulations; said in a warning. With known noise
/// in other channels this sets their share right; model errors count as noise here, which is said
/// in a warning.
///
/// @param problem  its estimated standard deviations, and its tolerance, are changed
/// @param found    optimum and result are those of the last round
void estimate_weights(Problem& problem, Evaluator& evaluator, const FitOptions& options,
                      MultiStart& found, std::vector<std::string>& warnings);

}  // namespace rigcal::calib
