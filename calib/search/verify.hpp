#pragma once

#include <vector>

#include "calib/search/multi_start.hpp"

namespace rigcal::calib {

/// Simulates the optimum, unless the search has kept every row of it, and checks that a fit that
/// claims to have converged is at a minimum: a start restored from a checkpoint may end anywhere.
/// If it is not at a minimum, the search continues from there.
///
/// @param found  gets the simulated optimum and its result
/// @return       rows per condition; empty if there is no optimum
std::vector<ConditionRows> verify_optimum(const Problem& problem, Evaluator& evaluator,
                                          const FitOptions& options, MultiStart& found);

}  // namespace rigcal::calib
