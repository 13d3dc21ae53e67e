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

/// Ceres' own 1e4 is all but a full Gauss-Newton step: far from the optimum it ends in a corner of
/// the box, where it may stay.
inline constexpr double kFirstTrustRadius = 10.0;
/// Near it the full step is the right one.
inline constexpr double kNearTrustRadius = 1e8;

/// Calls Ceres until the point is near enough to a minimum, with simulations of the evaluator's
/// effort: stationary where they are exact, else to about a standard error, or as far as an opening
/// tells. Where Ceres stops
/// elsewhere it is called again from the best point with a fresh trust region, up to three times.
///
/// Parameters at a bound that the cost pushes outwards are held there in the next call, because a
/// projected Gauss-Newton step is none for the others; those that it pushes inwards are let go.
///
/// @param z           where it starts, in the unit box
/// @param iterations  budget of all calls together
/// @param start       number of the start, for `options.progress`
SolveResult descend(const Problem& problem, Evaluator& evaluator, std::vector<double> z,
                    double trust_radius, int iterations, int start, const FitOptions& options);

/// The result where not even the start could be simulated.
SolveResult no_start(const Problem& problem, const Evaluator& evaluator, const Evaluation& first);

/// Why a fit ended that did not come to an end by itself.
std::string stop_reason(const Evaluator& evaluator, int iterations);

std::string converged_after(int iterations);

/// The first condition that could not be simulated, with time, reason and values.
std::string describe_failure(const Problem& problem, const Evaluation& evaluation);

}  // namespace rigcal::calib
