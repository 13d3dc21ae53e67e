#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "calib/problem/evaluation.hpp"
#include "calib/result/search_report.hpp"
#include "calib/search/budget.hpp"

namespace rigcal::calib {

/// Counts the evaluations that a search has made, and those that failed.
struct EvaluationCounters {
  long evaluations = 0;
  long failure_count = 0;
  std::vector<SimulationFailure> failures;  ///< the first few failures for each condition and kind
  std::map<std::pair<std::size_t, model::SimulationStatus>, int> kept;

  void record(const Problem& problem, const Evaluation& evaluation, int start);
  /// Adds the counts of evaluations that were made after those counted here.
  void add(const EvaluationCounters& later, const Problem& problem);
};

/// Evaluates all conditions of a problem at one fidelity, within a budget.
///
/// Every evaluation includes sensitivities. Almost every trial point becomes the next iterate,
/// whose Jacobian is then available, and cost and gradient come from the same solver steps. The
/// last point and the best point are kept, so that they need not be evaluated again.
class Evaluator {
 public:
  /// Borrows the budget and the problem. If the weights of the problem change between solves, call
  /// forget().
  Evaluator(const Problem& problem, Budget& budget, int threads = 1)
      : problem_(problem), budget_(budget), threads_(threads) {}
  /// Copies the kept points of another evaluator, but uses a separate budget and counters.
  Evaluator(const Evaluator& other, Budget& budget)
      : problem_(other.problem_),
        budget_(budget),
        threads_(other.threads_),
        last_(other.last_),
        best_(other.best_),
        fidelity_(other.fidelity_) {}

  /// Returns the evaluation at z. If a condition cannot be simulated, the failure is recorded and
  /// the evaluation is not ok.
  const Evaluation& evaluate(std::span<const double> z);
  /// Evaluates z even if the budget is spent, so that a stopped fit can still be scored with whole
  /// records.
  const Evaluation& conclude(std::span<const double> z);

  /// Begins with a point that was evaluated elsewhere, and counts that evaluation.
  void begin_with(Evaluation evaluation);

  /// Sets the fidelity of future simulations, and clears the cache if the fidelity changes.
  void set_fidelity(const Fidelity& fidelity);
  const Fidelity& fidelity() const { return fidelity_; }
  /// From now on, evaluations at the working tolerance keep their rows for verify_optimum().
  void keep_rows() { keep_rows_ = true; }

  /// Begins a start of a multi-start. From then on, best() is the best point of this start.
  void begin_start(int number);
  /// Clears the cache.
  void forget();
  /// Returns the point with the lowest cost so far; it is not ok if no point has been evaluated.
  const Evaluation& best() const { return best_; }
  /// Makes the last point the best one, regardless of its cost.
  void take_last() { best_ = last_; }

  const Budget& budget() const { return budget_; }
  int threads() const { return threads_; }
  /// Counts an evaluation that was made elsewhere, and records its failures.
  void record(const Evaluation& evaluation);
  const EvaluationCounters& counters() const { return counters_; }
  /// Sets the counters with which a resumed fit continues.
  void set_counters(EvaluationCounters counters);
  /// Adds the counts of another evaluator for the same problem.
  void add(const EvaluationCounters& counters);

 private:
  Evaluation evaluate_now(std::span<const double> z, const std::atomic<bool>* cancel) const;
  void keep_best();

  const Problem& problem_;
  Budget& budget_;
  int threads_;
  bool keep_rows_ = false;
  Evaluation last_;
  Evaluation best_;
  Fidelity fidelity_ = Fidelity::full;
  int start_ = 1;
  EvaluationCounters counters_;
};

}  // namespace rigcal::calib
