#pragma once

#include <vector>

#include "calib/search/multi_start.hpp"

namespace rigcal::calib {

/// Simulates the optimum, unless the search has kept every row of it, and checks that a fit that
/// claims to have converged is at a minimum: the end of a start that a checkpoint brings back may
/// be anywhere. If it is not, the search goes on from there.
///
/// @param found  its optimum becomes the simulated one, its result what that one is
/// @return       rows per condition; empty if there is no optimum
std::vector<ConditionRows> verify_optimum(const Problem& problem, Evaluator& evaluator,
                                          const FitOptions& options, MultiStart& found);

}  // namespace rigcal::calib
