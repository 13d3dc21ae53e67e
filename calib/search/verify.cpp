#include "calib/search/verify.hpp"

namespace rigcal::calib {
namespace {

std::vector<ConditionRows> simulate(const Problem& problem, Evaluator& evaluator, int threads,
                                    Evaluation& optimum) {
  std::vector<ConditionRows> rows;
  EvaluationOptions options;
  options.rows = &rows;
  optimum = evaluate_at(problem, optimum.z, threads, options);
  evaluator.record(optimum);
  return rows;
}

}  // namespace

std::vector<ConditionRows> verify_optimum(const Problem& problem, Evaluator& evaluator,
                                          const FitOptions& options, MultiStart& found) {
  if (!found.optimum.ok) return {};
  const bool claimed = found.result.status == FitStatus::converged;
  auto rows = simulate(problem, evaluator, options.threads, found.optimum);
  if (found.optimum.ok && claimed && !check_optimum(problem, found.optimum).nearly_stationary()) {
    if (search_on(problem, evaluator, options, found)) report_best(problem, found);
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
