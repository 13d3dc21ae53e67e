#pragma once

#include "calib/evaluator.hpp"
#include "calib/optimum.hpp"

namespace rigcal::calib {

/// End of one start: the best point is the evaluator's best().
struct SolveResult {
  FitStatus status = FitStatus::failed;
  std::string message;  ///< in words
  int iterations = 0;
  OptimumCheck check;  ///< of the best point, if there is one
};

/// Least squares by Ceres from z in the unit box. `converged` is what check_optimum() finds
/// stationary, or nearly so where Ceres says that it converged too. Where Ceres stops elsewhere it
/// is called again from the best point with a fresh trust region, up to three times.
///
/// Parameters at a bound that the cost pushes outwards are held there in the next call, because a
/// projected Gauss-Newton step is none for the others; those that it pushes inwards are let go.
///
/// First to about a standard error with coarse simulations, of the first periods where records
/// repeat themselves, then on from there with those of the problem's tolerance; the result is of
/// the latter. A last short step is predicted, not simulated: settle() judges where it ends.
///
/// @param iterations  budget of all calls together
/// @param start       number of the start, for `options.progress`
SolveResult solve(const Problem& problem, Evaluator& evaluator, std::vector<double> z,
                  int iterations, int start, const FitOptions& options);

/// How a last short step may end.
enum class LastStep {
  predicted,  ///< where the derivatives predict, not simulated again
  simulated,
};

/// The same without coarse simulations, from a point near the optimum.
SolveResult refine(const Problem& problem, Evaluator& evaluator, std::vector<double> z,
                   int iterations, int start, const FitOptions& options,
                   LastStep last = LastStep::predicted);

/// The first condition that could not be simulated, with time, reason and values.
std::string describe_failure(const Problem& problem, const Evaluation& evaluation);

}  // namespace rigcal::calib
