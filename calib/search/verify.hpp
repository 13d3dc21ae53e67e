#pragma once

#include <vector>

#include "calib/search/multi_start.hpp"

namespace rigcal::calib {

/// Simulates the optimum at full fidelity and checks that a fit that claims to have converged is at
/// a minimum: its last step may have been predicted, also that of a start restored from a
/// checkpoint. If it is not, the search goes on from there with every step simulated.
///
/// @param found  its optimum becomes the simulated one, its result what that one is
/// @return       rows per condition; empty if there is no optimum
std::vector<ConditionRows> verify_optimum(const Problem& problem, Evaluator& evaluator,
                                          const FitOptions& options, MultiStart& found);

}  // namespace rigcal::calib
