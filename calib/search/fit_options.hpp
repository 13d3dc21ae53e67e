#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "calib/result/posterior.hpp"

namespace rigcal {
class TaskFarm;  // common/task_farm.hpp
}

namespace rigcal::calib {

class Budget;       // budget.hpp
struct Checkpoint;  // checkpoint.hpp
struct Problem;     // calib/problem/problem.hpp

/// Options of a fit in addition to the campaign and its records.
struct FitOptions {
  int starts = 1;  ///< 1: only the campaign's start values; more: also a latin hypercube
  /// Number of latin-hypercube starts in addition to a single start. If that start converges, they
  /// are evaluated only coarsely. Otherwise each is searched like the first.
  int further_starts = 0;
  std::uint64_t seed = 1;    ///< seed for the latin hypercube
  int threads = 1;           ///< the results are bitwise identical for any number
  int max_iterations = 200;  ///< maximum number of iterations per start
  /// Limit for the whole job; if reached, the status is `stopped`.
  std::optional<long> max_evaluations;
  /// Limit for the whole job; if reached, the status is `stopped`.
  std::optional<double> max_seconds;
  bool consider = true;   ///< whether to consider small effects that the model omits
  int bootstrap = 0;      ///< number of replicates, each fitted from the optimum; 0: none
  int posterior = 0;      ///< number of posterior draws per chain; 0: none
  bool profiles = false;  ///< whether to compute the profile likelihood of all unknowns except
                          ///< nuisance parameters
  bool cross_validate = false;         ///< whether to leave out one condition at a time
  const Checkpoint* resume = nullptr;  ///< checkpoint to continue from
  std::function<void(const Checkpoint&)> checkpoint;  ///< called after every completed start
  /// Runs the starts (if it has several processes), replicates, profiles and folds. If null, they
  /// run on the threads of this process.
  TaskFarm* farm = nullptr;
  /// Set to true to end the fit with the best point so far.
  const std::atomic<bool>* cancel = nullptr;
  /// Called after every iteration with the number of the start (from 1), the number of the
  /// iteration, the cost, the relative change in cost, and the time in seconds.
  std::function<void(int, int, double, double, double)> progress;
  /// Called during bootstrap, profiles, posterior and cross-validation with their name ("replicates
  /// of the bootstrap"), the number done and the total number. May be called from any thread.
  std::function<void(const char*, int, int)> beside;
  /// Computes the leak shares over draws of the posterior, which are unit-box coordinates, shape
  /// (draws, unknowns). If the budget is interrupted, the result is empty. A share is defined by
  /// the diagnosis, on which the calibration does not depend. If null, no shares are computed.
  std::function<std::vector<DrawnShare>(
      const Problem&, const std::vector<std::vector<double>>& draws, const Budget&)>
      shares;

  void validate() const;
};

}  // namespace rigcal::calib
