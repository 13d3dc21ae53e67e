#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>

namespace rigcal {
class TaskFarm;  // common/task_farm.hpp
}

namespace rigcal::calib {

struct Checkpoint;  // checkpoint.hpp

/// Options of a fit in addition to the campaign and its records.
struct FitOptions {
  int starts = 1;  ///< 1: the campaign's start values; more: latin hypercube around them
  /// Latin-hypercube starts in addition to a single one. If that one converges they are only
  /// evaluated coarsely; otherwise each is searched like the first.
  int further_starts = 0;
  std::uint64_t seed = 1;               ///< for the latin hypercube
  int threads = 1;                      ///< results are the same bits for any number
  int max_iterations = 200;             ///< per start
  std::optional<long> max_evaluations;  ///< limit for the whole job; then: `stopped`
  std::optional<double> max_seconds;    ///< limit for the whole job; then: `stopped`
  bool consider = true;                 ///< the small effects that the model leaves out
  int bootstrap = 0;                    ///< replicates, each fitted from the optimum; 0: none
  int posterior = 0;                    ///< draws of each chain of the posterior; 0: none
  bool profiles = false;                ///< profile likelihood of every unknown that is no nuisance
  bool cross_validate = false;          ///< leave one condition out after the other
  const Checkpoint* resume = nullptr;   ///< checkpoint to continue from
  std::function<void(const Checkpoint&)> checkpoint;  ///< called after every finished start
  /// Makes starts (where it has several processes), replicates, profiles and folds; null: the
  /// threads of this process do.
  TaskFarm* farm = nullptr;
  const std::atomic<bool>* cancel = nullptr;  ///< ends the fit with the best so far
  /// Called after every iteration: start (from 1), iteration, cost, relative change of cost,
  /// seconds.
  std::function<void(int, int, double, double, double)> progress;
  /// Called during bootstrap, profiles, posterior and cross-validation: their name ("replicates of
  /// the bootstrap"), number done, total number. From any thread.
  std::function<void(const char*, int, int)> beside;

  void validate() const;
};

}  // namespace rigcal::calib
