#pragma once

#include <string>
#include <vector>

#include "calib/search/evaluator.hpp"
#include "calib/search/optimum.hpp"

namespace rigcal::calib {

/// End of one start: the best point is the evaluator's best().
struct SolveResult {
  FitStatus status = FitStatus::failed;
  std::string message;  ///< in words
  int iterations = 0;
  OptimumCheck check;  ///< of the best point, if there is one
};

/// Ceres' default of 1e4 is effectively unlimited: from a poor start the first step may end in a
/// corner of the bounds and stay there.
inline constexpr double kFirstTrustRadius = 10.0;
/// Near it the full step is the right one.
inline constexpr double kNearTrustRadius = 1e8;

/// Trust-region minimisation by Ceres at the evaluator's fidelity: to a stationary point where the
/// simulations are exact, else to within about a standard error, or until a short horizon carries
/// no more information. Where Ceres stops elsewhere it is called again from the best point with a
/// fresh trust region, up to three times.
///
/// Parameters at an active bound are fixed there in the next call, because a projected Gauss-Newton
/// step is not the right step for the others; those that the cost pushes inwards are released.
///
/// @param z           where it starts, in the unit box
/// @param iterations  budget of all calls together
/// @param start       number of the start, for `options.progress`
SolveResult minimise(const Problem& problem, Evaluator& evaluator, std::vector<double> z,
                     double trust_radius, int iterations, int start, const FitOptions& options);

/// The result where not even the start could be simulated.
SolveResult no_start(const Problem& problem, const Evaluator& evaluator, const Evaluation& first);

/// Why a fit ended that did not come to an end by itself.
std::string stop_reason(const Evaluator& evaluator, int iterations);

std::string converged_after(int iterations);

/// The first condition that could not be simulated, with time, reason and values.
std::string describe_failure(const Problem& problem, const Evaluation& evaluation);

}  // namespace rigcal::calib
