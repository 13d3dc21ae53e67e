#pragma once

#include <string>
#include <vector>

#include "calib/search/evaluator.hpp"
#include "calib/search/iterations.hpp"
#include "calib/search/optimum.hpp"
#include "calib/search/stage.hpp"

namespace rigcal::calib {

/// Result of one start. The best point is the evaluator's best().
struct SolveResult {
  FitStatus status = FitStatus::failed;
  std::string message;  ///< explanation in words
  int iterations = 0;   ///< iterations of the start, over all stages
  OptimumCheck check;   ///< check of the best point, if there is one
};

/// Minimises with Ceres' trust-region method at the evaluator's fidelity. With exact simulations it
/// continues to a stationary point. With coarse simulations it ends within about a standard error
/// of one, or when a short horizon has no more information to offer. If Ceres stops elsewhere it is
/// called again from the best point with a new trust region, up to three times.
///
/// Parameters at an active bound are fixed there in the next call, because a projected Gauss-Newton
/// step is not the right step for the others. Parameters that the cost pushes back into the box are
/// released.
///
/// @param z  start point, in the unit box
SolveResult minimise(const Problem& problem, Evaluator& evaluator, std::vector<double> z,
                     const Stage& stage, Iterations& iterations);

/// Returns the result for a start at which not even the first point could be simulated.
SolveResult no_start(const Problem& problem, const Evaluator& evaluator, const Evaluation& first);

/// Explains why a fit ended before it converged.
///
/// @param most_iterations  limit on iterations
std::string stop_reason(const Evaluator& evaluator, int most_iterations);

SolveResult converged(const Iterations& iterations, const OptimumCheck& check);

/// Describes the first condition that could not be simulated, with time, reason and values.
std::string describe_failure(const Problem& problem, const Evaluation& evaluation);

}  // namespace rigcal::calib
