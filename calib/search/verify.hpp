#pragma once

#include <vector>

#include "calib/search/multi_start.hpp"

namespace rigcal::calib {

/// Simulates the optimum, unless the search has kept all its rows. Checks that a fit reported as
/// converged really is at a minimum, because a start restored from a checkpoint may have ended
/// anywhere. If it is not at a minimum, the search continues from there.
///
/// @param found  receives the simulated optimum and its result
/// @return       rows for each condition; empty if there is no optimum
std::vector<ConditionRows> verify_optimum(const Problem& problem, Evaluator& evaluator,
                                          const FitOptions& options, MultiStart& found);

}  // namespace rigcal::calib
