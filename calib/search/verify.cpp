#include "calib/search/verify.hpp"

namespace rigcal::calib {

std::vector<ConditionRows> verify_optimum(const Problem& problem, Evaluator& evaluator,
                                          const FitOptions& options, MultiStart& found) {
  if (!found.optimum.ok) return {};
  const bool claimed = found.result.status == FitStatus::converged;
  const auto simulate = [&] {
    if (found.optimum.rows) return;  // the last evaluation in the search already has all rows
    found.optimum =
        evaluate_at(problem, found.optimum.z, options.threads, {Fidelity::full, nullptr, true});
    evaluator.record(found.optimum);
  };
  simulate();
  if (found.optimum.ok && claimed && !check_optimum(problem, found.optimum).is_minimum()) {
    if (search_on(problem, evaluator, options, found)) report_best(problem, found);
    simulate();
  }
  if (!found.optimum.ok) {
    found.result.status = FitStatus::failed;
    found.result.message = "the optimum " + describe_failure(problem, found.optimum);
    return {};
  }
  found.result.check = check_optimum(problem, found.optimum);
  evaluator.forget();  // frees a second copy of the rows, which may be large
  std::vector<ConditionRows> rows = std::move(*found.optimum.rows);
  found.optimum.rows.reset();
  return rows;
}

}  // namespace rigcal::calib
