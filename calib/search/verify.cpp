#include "calib/search/verify.hpp"

#include <fmt/format.h>

namespace rigcal::calib {
namespace {

/// Solves on from an optimum that is none, every step simulated: where the model leaves more than
/// noise, errors of the derivatives count times that, and predict too much.
void solve_on(const Problem& problem, Evaluator& evaluator, const FitOptions& options,
              MultiStart& found) {
  const int before = found.result.iterations;
  evaluator.forget();
  found.result = polish(problem, evaluator, found.optimum.z, options.max_iterations, found.best,
                        options, LastStep::simulated);
  found.result.iterations += before;
  if (found.result.status == FitStatus::converged)
    found.result.message = fmt::format("converged after {} iterations", found.result.iterations);
  if (!evaluator.best().ok) return;
  found.optimum = evaluator.best();
  report_best(problem, found);
}

/// Simulates the optimum, or the point that it was predicted from where that is all there is.
std::vector<ConditionRows> simulate(const Problem& problem, Evaluator& evaluator, int threads,
                                    Evaluation& optimum) {
  std::vector<ConditionRows> rows;
  EvaluationOptions options;
  options.rows = &rows;
  Evaluation found = evaluate_at(problem, optimum.z, threads, options);
  evaluator.record(found);
  if (!found.ok && !optimum.simulated()) {
    found = evaluate_at(problem, optimum.predicted_from, threads, options);
    evaluator.record(found);
  }
  optimum = std::move(found);
  return rows;
}

}  // namespace

std::vector<ConditionRows> verify_optimum(const Problem& problem, Evaluator& evaluator,
                                          const FitOptions& options, MultiStart& found) {
  if (!found.optimum.ok) return {};
  const bool claimed = found.result.status == FitStatus::converged;
  auto rows = simulate(problem, evaluator, options.threads, found.optimum);
  if (found.optimum.ok && claimed && !check_optimum(problem, found.optimum).nearly_stationary()) {
    solve_on(problem, evaluator, options, found);
    rows = simulate(problem, evaluator, options.threads, found.optimum);
  }
  if (!found.optimum.ok) {
    found.result.status = FitStatus::failed;
    found.result.message = "the optimum " + describe_failure(problem, found.optimum);
    return {};
  }
  found.result.check = check_optimum(problem, found.optimum);
  return rows;
}

}  // namespace rigcal::calib
