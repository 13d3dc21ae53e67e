#pragma once

#include "calib/search/minimise.hpp"
#include "calib/search/stage.hpp"

namespace rigcal::calib {

/// Solves the least-squares problem from one start, in the unit box. The end point is the
/// evaluator's best(). A search has `converged` if check_optimum() finds the point stationary; if
/// Ceres has converged as well, almost stationary is enough. Borrows everything.
class Search {
 public:
  /// @param start   number of the start, for progress and messages
  /// @param before  iterations that the start has already made
  Search(const Problem& problem, Evaluator& evaluator, const FitOptions& options, int start = 1,
         int before = 0)
      : problem_(problem),
        evaluator_(evaluator),
        options_(options),
        iterations_(options, start, before) {}

  /// Runs the stages of plan_schedule(). If the search is stopped, the best point is the stage end
  /// point with the lowest cost over whole records.
  SolveResult run(std::vector<double> z);

  /// Runs all stages except the last. The best point is the one with the lowest cost over whole
  /// records, simulated coarsely.
  ///
  /// @return  false if there is no such point, or if the budget has been spent
  bool approach(std::vector<double> z);

  /// Runs only the last stage, from a point close to the optimum.
  SolveResult polish(std::vector<double> z);

 private:
  SolveResult run_stages(std::vector<double> z, bool polished);
  bool enter(const Stage& stage);
  OptimumCheck full_steps();
  SolveResult stopped();

  const Problem& problem_;
  Evaluator& evaluator_;
  const FitOptions& options_;
  Iterations iterations_;

  std::vector<double> z_;       ///< end point of the stages so far
  std::vector<double> begin_;   ///< start point of the stages
  double begin_cost_ = 0.0;     ///< cost of whole records at the start point
  std::vector<double> before_;  ///< start point of the last horizon
  double foreseen_ = 0.0;       ///< mean square residual at the end of the last horizon
  int horizons_until_ = 0;      ///< number of iterations after which no further horizon is used
  std::vector<std::vector<double>> ends_;  ///< end points of the stages
};

}  // namespace rigcal::calib
