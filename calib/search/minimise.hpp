#pragma once

#include <string>
#include <vector>

#include "calib/search/evaluator.hpp"
#include "calib/search/iterations.hpp"
#include "calib/search/optimum.hpp"
#include "calib/search/stage.hpp"

namespace rigcal::calib {

/// End of one start: the best point is the evaluator's best().
struct SolveResult {
  FitStatus status = FitStatus::failed;
  std::string message;  ///< in words
  int iterations = 0;   ///< iterations of its start, all stages together
  OptimumCheck check;   ///< check of the best point, if there is one
};

/// Trust-region minimisation by Ceres at the evaluator's fidelity: to a stationary point where the
/// simulations are exact, else to within about a standard error, or until a short horizon carries
/// no more information. Where Ceres stops elsewhere it is called again from the best point with a
/// fresh trust region, up to three times.
///
/// Parameters at an active bound are fixed there in the next call, because a projected Gauss-Newton
/// step is not the right step for the others; those that the cost pushes inwards are released.
///
/// @param z  where it starts, in the unit box
SolveResult minimise(const Problem& problem, Evaluator& evaluator, std::vector<double> z,
                     const Stage& stage, Iterations& iterations);

/// The result where not even the start could be simulated.
SolveResult no_start(const Problem& problem, const Evaluator& evaluator, const Evaluation& first);

/// Reason why a fit ended before it converged.
///
/// @param most_iterations  limit of iterations
std::string stop_reason(const Evaluator& evaluator, int most_iterations);

SolveResult converged(const Iterations& iterations, const OptimumCheck& check);

/// The first condition that could not be simulated, with time, reason and values.
std::string describe_failure(const Problem& problem, const Evaluation& evaluation);

}  // namespace rigcal::calib
