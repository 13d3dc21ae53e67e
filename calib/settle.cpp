#include "calib/settle.hpp"

#include <fmt/format.h>

namespace rigcal::calib {
namespace {

constexpr int kMoreRounds = 2;

/// Solves on from an optimum that is none.
void solve_on(const Problem& problem, Evaluator& evaluator, const FitOptions& options,
              MultiStart& found) {
  const int before = found.result.iterations;
  evaluator.forget();
  found.result =
      refine(problem, evaluator, found.optimum.z, options.max_iterations, found.best, options);
  found.result.iterations += before;
  if (found.result.status == FitStatus::converged)
    found.result.message = fmt::format("converged after {} iterations", found.result.iterations);
  if (evaluator.best().ok) found.optimum = evaluator.best();
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

std::vector<ConditionRows> settle(const Problem& problem, Evaluator& evaluator,
                                  const FitOptions& options, MultiStart& found) {
  std::vector<ConditionRows> rows;
  for (int round = 0; found.optimum.ok; ++round) {
    const bool predicted = !found.optimum.simulated();
    rows = simulate(problem, evaluator, options.threads, found.optimum);
    SolveResult& result = found.result;
    if (!found.optimum.ok) {
      result.status = FitStatus::failed;
      result.message = "the optimum " + describe_failure(problem, found.optimum);
      break;
    }
    result.check = check_optimum(problem, found.optimum);
    const bool claimed = predicted && result.status == FitStatus::converged;
    if (!claimed || result.check.nearly_stationary()) return rows;
    if (round == kMoreRounds || evaluator.aborted()) {
      result.status = evaluator.aborted() ? FitStatus::stopped : FitStatus::failed;
      result.message = fmt::format(
          "a step of {:.2g} standard errors is left where the last one ended: not a minimum",
          result.check.relative_offset);
      return rows;
    }
    solve_on(problem, evaluator, options, found);
  }
  return {};
}

}  // namespace rigcal::calib
