#pragma once

#include "calib/search/minimise.hpp"
#include "calib/search/stage.hpp"

namespace rigcal::calib {

/// Least squares from one start, in the unit box. The end point is the evaluator's best(). A search
/// has `converged` if check_optimum() finds the point stationary, or nearly so if Ceres converged,
/// too. Borrows everything.
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

  /// Runs multiple shooting if the campaign asks for it, then the stages of plan_schedule(). After
  /// a stop the best point is the end of a stage with the least cost over whole records.
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

  std::vector<double> z_;                  ///< end of the stages so far
  std::vector<double> begin_;              ///< start of the stages
  double begin_cost_ = 0.0;                ///< cost of whole records there
  std::vector<double> before_;             ///< start of the last horizon
  double foreseen_ = 0.0;                  ///< mean square that the last horizon ended with
  int horizons_until_ = 0;                 ///< iterations used, after which horizons end
  std::vector<std::vector<double>> ends_;  ///< ends of stages
};

}  // namespace rigcal::calib
