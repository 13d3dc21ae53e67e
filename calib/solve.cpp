#include "calib/solve.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "calib/problem/measured_tolerance.hpp"
#include "calib/search/checkpoint.hpp"
#include "calib/search/late_flag.hpp"
#include "calib/search/verify.hpp"
#include "calib/search/weights.hpp"
#include "calib/trust/findings.hpp"
#include "calib/trust/identifiability.hpp"
#include "common/memory.hpp"

namespace rigcal::calib {
namespace {

/// Step budget of later points relative to the number of steps at the start with a coarse
/// tolerance. A later point may need many steps up to the end of the record, while the start soon
/// becomes periodic.
constexpr long kStepsOverStart = 100;
/// Minimum budget, for starts at which nothing moves, so that they take fewer than twenty steps.
constexpr long kLeastSteps = 20'000;

void budget_steps(Problem& problem, const Evaluation& start) {
  if (!start.ok) return;
  for (std::size_t i = 0; i < problem.conditions.size(); ++i) {
    problem.conditions[i].max_steps =
        std::max(kLeastSteps, kStepsOverStart * start.conditions[i].steps);
  }
}

/// Withdraws a convergence whose errors or findings the user did not wait for.
void note_interruption(const Problem& problem, Fit& fit) {
  if (fit.status != FitStatus::converged || !is_raised(problem.cancel)) return;
  fit.status = FitStatus::stopped;
  fit.message += "; stopped on request before its uncertainty was complete";
}

}  // namespace

Solved solve_problem(Problem& problem, Evaluator& evaluator, const FitOptions& options, Fit& fit) {
  evaluator.set_fidelity(problem.of_starts());
  budget_steps(problem, evaluator.evaluate(problem.start()));
  const std::atomic<bool>* cancel = evaluator.budget().cancel();
  measure_tolerances(problem, problem.start(), options.threads, cancel);
  MultiStart found = multi_start(problem, evaluator, options);
  go_on_with_best(problem, evaluator, options, found);
  if (found.optimum.ok && problem.has_estimated_sd()) {
    estimate_weights(problem, evaluator, options, found, fit.warnings);
  } else if (found.optimum.ok &&
             refine_tolerances(problem, found.optimum.z, options.threads, cancel) &&
             search_on(problem, evaluator, options, found)) {
    report_best(problem, found);
  }
  std::vector<ConditionRows> rows = verify_optimum(problem, evaluator, options, found);
  fit.status = found.result.status;
  fit.message = found.result.message;
  fit.starts = std::move(found.starts);
  const auto made = static_cast<int>(fit.starts.size());
  if (made < options.starts && fit.status == FitStatus::converged) {
    // One of the starts that were never run could have been better.
    fit.status = FitStatus::stopped;
    fit.message = fmt::format("stopped after {} of {} starts; the best of these {}", made,
                              options.starts, fit.message);
  }
  fit.best_start = found.best;
  fit.further_starts = found.further_starts;
  fit.evaluations = evaluator.counters().evaluations;
  fit.failures = evaluator.counters().failures;
  fit.failure_count = evaluator.counters().failure_count;
  fit.residual_count = problem.residual_count();
  fit.tolerance = problem.tolerance;
  if (!found.optimum.ok) {
    if (fit.starts.size() > 1)
      fit.message = "no start could be simulated; the first one: " + fit.message;
    return {};
  }
  give_freed_memory_back();  // the next steps allocate blocks of other sizes
  const bool awaited = found.result.status == FitStatus::stopped && evaluator.budget().cancelled();
  Uncertainty errors = uncertainty(problem, found.optimum, std::move(rows), options.threads,
                                   awaited ? Detail::plain : Detail::full);
  note_interruption(problem, fit);
  auto open =
      describe_findings(problem, found.optimum, found.result.check, errors, options.threads, fit);
  const bool stopped = fit.status == FitStatus::stopped;
  note_interruption(problem, fit);
  if (fit.status == FitStatus::stopped && !stopped) withhold_grades(fit.parameters);
  return {std::move(found.optimum), std::move(errors), std::move(open)};
}

Solved solve_from_starts(Problem& problem, Evaluator& evaluator, const FitOptions& options,
                         Fit& fit) {
  if (options.starts > 1 || options.further_starts == 0)
    return solve_problem(problem, evaluator, options, fit);
  const Problem fresh = problem;
  const std::vector<std::string> warnings = fit.warnings;
  Solved first = solve_problem(problem, evaluator, options, fit);
  if (fit.status == FitStatus::converged || !first.optimum.ok || evaluator.budget().spent())
    return first;
  const Checkpoint checkpoint{fit.starts, fit.best_start, first.optimum.z, evaluator.counters()};
  FitOptions more = options;
  more.starts += options.further_starts;
  more.resume = &checkpoint;
  problem = fresh;  // discards the weights: estimated away from a minimum, they are wrong for other
                    // starts
  evaluator.forget();
  const std::string why = fit.message;
  fit = {};
  fit.warnings = warnings;
  fit.warnings.push_back(
      fmt::format("the fit from the campaign's start values did not reach a minimum ({}): {} "
                  "further starts were made, as with --starts {}",
                  why, options.further_starts, more.starts));
  return solve_problem(problem, evaluator, more, fit);
}

}  // namespace rigcal::calib
