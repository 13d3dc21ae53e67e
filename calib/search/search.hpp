#pragma once

#include "calib/search/minimise.hpp"
#include "calib/search/stage.hpp"

namespace rigcal::calib {

/// Least squares from one start, in the unit box. The end point is the evaluator's best().
/// `converged` is what check_optimum() finds stationary, or nearly so where Ceres says that it
/// converged too. Borrows everything.
class Search {
 public:
  /// @param start   its number, for progress and messages
  /// @param before  iterations that it has taken already
  Search(const Problem& problem, Evaluator& evaluator, const FitOptions& options, int start = 1,
         int before = 0)
      : problem_(problem),
        evaluator_(evaluator),
        options_(options),
        iterations_(options, start, before) {}

  /// Multiple shooting where the campaign asks for it, then the stages of plan_schedule(). Where it
  /// is stopped, the best point is that of the stages' ends with the least cost over whole records.
  SolveResult run(std::vector<double> z);

  /// Runs all stages but the last. The best point is the one with the least cost over whole
  /// records, by coarse simulations.
  ///
  /// @return  false if there is no such point, or the budget was spent
  bool approach(std::vector<double> z);

  /// The last stage alone, from a point near the optimum.
  SolveResult polish(std::vector<double> z);

 private:
  std::vector<double> shoot(std::vector<double> z, double interval_s);
  SolveResult run_stages(std::vector<double> z, bool polished);
  bool enter(const Stage& stage);
  OptimumCheck full_steps();
  SolveResult stopped();

  const Problem& problem_;
  Evaluator& evaluator_;
  const FitOptions& options_;
  Iterations iterations_;

  std::vector<double> z_;                  ///< where the stages have led
  std::vector<double> begin_;              ///< where they began
  double begin_cost_ = 0.0;                ///< of whole records there
  std::vector<double> before_;             ///< where the last horizon began
  double foreseen_ = 0.0;                  ///< mean square that the last horizon ended with
  int horizons_until_ = 0;                 ///< iterations used, after which horizons end
  std::vector<std::vector<double>> ends_;  ///< of stages
};

}  // namespace rigcal::calib
