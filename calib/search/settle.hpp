#pragma once

#include <vector>

#include "calib/search/multi_start.hpp"

namespace rigcal::calib {

/// Simulates the optimum with every row of it, which tells whether what claims to have converged is
/// at a minimum: its last step may have been predicted, also that of a start that a checkpoint
/// brought back. If it is not, solves on from there, every step simulated.
///
/// @param found  its optimum becomes the simulated one, its result what that one is
/// @return       rows per condition; empty if there is no optimum
std::vector<ConditionRows> settle(const Problem& problem, Evaluator& evaluator,
                                  const FitOptions& options, MultiStart& found);

}  // namespace rigcal::calib
