#pragma once

#include <atomic>
#include <chrono>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "calib/problem/evaluation.hpp"
#include "calib/result/search_report.hpp"
#include "calib/search/fit_options.hpp"

namespace rigcal::calib {

/// What an evaluator has counted.
struct EvaluationCounters {
  long evaluations = 0;
  long failure_count = 0;
  std::vector<SimulationFailure> failures;  ///< the first few of each condition and kind
  std::map<std::pair<std::size_t, model::SimulationStatus>, int> kept;

  /// As if what `later` has counted had been counted here, one after the other.
  void add(const EvaluationCounters& later, const Problem& problem);
};

/// How a point is evaluated.
struct EvaluationOptions {
  Fidelity fidelity = Fidelity::full;
  const std::atomic<bool>* cancel = nullptr;
  std::vector<ConditionRows>* rows = nullptr;  ///< if not null, receives those of each condition
  /// If not null, the simulations at that point, which are then not made anew.
  const std::vector<model::Simulation>* runs = nullptr;
};

/// Every condition at z, whatever limits say.
Evaluation evaluate_at(const Problem& problem, std::span<const double> z, int threads,
                       const EvaluationOptions& options = {});

/// Evaluates all conditions of a problem in parallel.
///
/// Every evaluation carries sensitivities: nearly every trial point becomes the next iterate, whose
/// Jacobian is then there already, and cost and gradient come from the same steps of the solver.
/// The last and the best point are kept, so that nothing is computed twice.
class Evaluator {
 public:
  using Clock = std::chrono::steady_clock;

  struct Options {
    int threads = 1;
    const std::atomic<bool>* cancel = nullptr;
    std::optional<Clock::time_point> deadline;
    std::optional<long> max_evaluations;
  };

  /// Borrows the problem, whose weights may change between solves: call forget() then.
  Evaluator(const Problem& problem, const Options& options)
      : problem_(problem), options_(options) {}

  /// The evaluation at z; not ok where a condition could not be simulated, which is recorded.
  const Evaluation& evaluate(std::span<const double> z);
  /// Evaluates even after cancellation or an exhausted budget, so that a stopped fit is still
  /// scored by whole records.
  const Evaluation& conclude(std::span<const double> z);

  /// Begins with a point that was evaluated elsewhere, and counts it.
  void begin_with(Evaluation evaluation);

  /// Sets the fidelity of the simulations to come, and clears the cache if it is another one.
  void set_fidelity(const Fidelity& fidelity);
  const Fidelity& fidelity() const { return fidelity_; }

  /// Begins a start of a multi-start: best() is then the best of this start.
  void begin_start(int number);
  /// Clears the cache.
  void forget();
  /// The point of lowest cost so far; not ok if there is none.
  const Evaluation& best() const { return best_; }

  /// Takes the last point for the best, whatever its cost.
  void take_last() { best_ = last_; }

  /// A signal, the time limit or that of evaluations ends the fit.
  bool out_of_time() const { return options_.deadline && Clock::now() >= *options_.deadline; }
  bool out_of_evaluations() const {
    return options_.max_evaluations && counters_.evaluations >= *options_.max_evaluations;
  }
  bool cancelled() const;
  bool aborted() const { return cancelled() || out_of_time() || out_of_evaluations(); }
  /// Counts an evaluation that was made elsewhere, and records its failures.
  void record(const Evaluation& evaluation);

  const Options& options() const { return options_; }
  const EvaluationCounters& counters() const { return counters_; }
  /// Goes on counting from there, as after a resumed fit.
  void set_counters(EvaluationCounters counters) { counters_ = std::move(counters); }
  /// Counts what another evaluator of the same problem has counted.
  void add(const EvaluationCounters& counters) { counters_.add(counters, problem_); }

 private:
  Evaluation evaluate_now(std::span<const double> z, const std::atomic<bool>* cancel) const;
  void keep_best();

  const Problem& problem_;
  Options options_;
  Evaluation last_;
  Evaluation best_;
  Fidelity fidelity_ = Fidelity::full;
  int start_ = 1;
  EvaluationCounters counters_;
};

}  // namespace rigcal::calib
