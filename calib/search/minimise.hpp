#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "calib/search/evaluator.hpp"
#include "calib/search/fit_options.hpp"
#include "calib/search/optimum.hpp"
#include "calib/search/stage.hpp"

namespace rigcal::calib {

/// Counts the iterations of one start. All stages of the start share one limit, and one count for
/// progress messages. Borrows the options.
class Iterations {
 public:
  /// @param start   number of the start
  /// @param before  iterations that the start has already made; they are included in the count, but
  ///                not in the limit
  explicit Iterations(const FitOptions& options, int start = 1, int before = 0)
      : options_(options), start_(start), before_(before) {}

  int most() const { return options_.max_iterations; }
  int used() const { return used_; }
  int left() const { return std::max(0, options_.max_iterations - used_); }
  int total() const { return before_ + used_; }
  void add(int iterations) { used_ += iterations; }

  /// Reports one iteration of a stage whose iterations have not been added yet.
  void tell(int iteration, double cost, double relative_change, double seconds) const {
    if (options_.progress)
      options_.progress(start_, total() + iteration, cost, relative_change, seconds);
  }

 private:
  const FitOptions& options_;
  int start_;
  int before_;
  int used_ = 0;
};

/// Result of one start. The best point is the evaluator's best().
struct SolveResult {
  FitStatus status = FitStatus::failed;
  std::string message;  ///< explanation in words
  int iterations = 0;   ///< iterations of the start, over all stages
  OptimumCheck check;   ///< check of the best point, if there is one
};

/// Minimises with Ceres' trust-region method at the evaluator's fidelity. With exact simulations it
/// continues to a stationary point. With coarse simulations it ends within about a standard error
/// of a stationary point, or when a short horizon can contribute little more. If Ceres stops
/// elsewhere it is called again from the best point with a new trust region, up to three times.
///
/// Parameters at an active bound are fixed there for the next call, because projecting a
/// Gauss-Newton step onto the bound does not give the right step for the others. Parameters are
/// released if the cost falls towards the inside of the box.
///
/// @param z  start point, in the unit box
SolveResult minimise(const Problem& problem, Evaluator& evaluator, std::vector<double> z,
                     const Stage& stage, Iterations& iterations);

/// Returns the result for a start at which not even the first point could be simulated.
SolveResult no_start(const Problem& problem, const Evaluator& evaluator, const Evaluation& first);

/// Explains why a fit ended before it had converged.
///
/// @param most_iterations  maximum number of iterations
std::string stop_reason(const Evaluator& evaluator, int most_iterations);

SolveResult converged(const Iterations& iterations, const OptimumCheck& check);

/// Describes the first condition that could not be simulated: the time, the reason and the
/// parameter values.
std::string describe_failure(const Problem& problem, const Evaluation& evaluation);

}  // namespace rigcal::calib
