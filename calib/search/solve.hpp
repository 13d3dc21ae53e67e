#pragma once

#include "calib/search/descend.hpp"

namespace rigcal::calib {

/// Least squares from z in the unit box. `converged` is what check_optimum() finds stationary, or
/// nearly so where Ceres says that it converged too.
///
/// First with coarse simulations, of longer and longer openings where records repeat themselves,
/// then on from there with those of the problem's tolerance; the result is of the latter. A last
/// short step is predicted, not simulated: settle() judges where it ends. Where the start is
/// stopped, the best point is the best of those that its stages ended at, by whole records.
///
/// @param iterations  budget of all calls together
/// @param start       number of the start, for `options.progress`
SolveResult solve(const Problem& problem, Evaluator& evaluator, std::vector<double> z,
                  int iterations, int start, const FitOptions& options);

/// How a last short step may end.
enum class LastStep {
  simulated,
  predicted,  ///< where the derivatives predict, not simulated again
  judged,     ///< the same for longer steps: the caller simulates where they end
};

/// The same without coarse simulations, from a point near the optimum.
SolveResult refine(const Problem& problem, Evaluator& evaluator, std::vector<double> z,
                   int iterations, int start, const FitOptions& options,
                   LastStep last = LastStep::predicted);
}  // namespace rigcal::calib
