#pragma once

#include "calib/search/minimise.hpp"

namespace rigcal::calib {

/// Least squares from z in the unit box. `converged` is what check_optimum() finds stationary, or
/// nearly so where Ceres says that it converged too.
///
/// The stages of a start: growing horizons at coarse fidelity where records are periodic, whole
/// records at coarse fidelity, then a polish at full fidelity, whose result this is. A last short
/// step is predicted, not simulated: verify_optimum() checks its end. Where the start is stopped,
/// the best point is that of the stages' ends with the least cost over whole records.
///
/// @param iterations  budget of all calls together
/// @param start       number of the start, for `options.progress`
SolveResult solve(const Problem& problem, Evaluator& evaluator, std::vector<double> z,
                  int iterations, int start, const FitOptions& options);

/// How a last short step may end.
enum class LastStep {
  simulated,
  predicted,  ///< where the derivatives predict, not simulated again
  judged,     ///< as predicted, for longer steps too; the caller must verify the end by simulation
};

/// The same without coarse simulations, from a point near the optimum.
SolveResult polish(const Problem& problem, Evaluator& evaluator, std::vector<double> z,
                   int iterations, int start, const FitOptions& options,
                   LastStep last = LastStep::predicted);
}  // namespace rigcal::calib
