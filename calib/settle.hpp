#pragma once

#include <vector>

#include "calib/multi_start.hpp"

namespace rigcal::calib {

/// Simulates the optimum with every row of it. Where the last step of the solver was predicted,
/// also before a checkpoint, this tells whether it ends at a minimum; if not, solves on from there,
/// every step simulated.
///
/// @param found  its optimum becomes the simulated one, its result what that one is
/// @return       rows per condition; empty if there is no optimum
std::vector<ConditionRows> settle(const Problem& problem, Evaluator& evaluator,
                                  const FitOptions& options, MultiStart& found);

}  // namespace rigcal::calib
