#include "calib/search/minimise.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "calib/descent/adaptive_descent.hpp"

namespace rigcal::calib {
namespace {

/// With coarse simulations, a search ends when the remaining step is at most this many standard
/// errors. The errors of the simulations themselves are larger.
constexpr double kCoarseOffset = 1.0;
/// A horizon ends when at most this fraction of the cost could still be removed.
constexpr double kHorizonLeaves = 0.05;
/// In addition, the remaining step must be at most this many standard errors. If there are many
/// samples, a parameter that is far off but affects only few of them contributes only a small
/// fraction of the cost.
constexpr double kHorizonOffset = 10.0;
/// Smallest relative change in cost that coarse simulations can resolve.
constexpr double kCoarseChange = 1e-4;

/// Returns true if further iterations on a horizon are not worthwhile. The next horizon, which is a
/// few times as long, contains far more information.
bool horizon_exhausted(const Problem& problem, const Evaluator& evaluator,
                       const OptimumCheck& check) {
  const Evaluation& best = evaluator.best();
  const double residuals = best.share * static_cast<double>(problem.residual_count());
  const bool noise = !problem.has_estimated_sd() && 2.0 * best.cost <= residuals;
  return noise || (check.reducible <= kHorizonLeaves && check.relative_offset <= kHorizonOffset);
}

bool near_enough(const Problem& problem, const Evaluator& evaluator, const OptimumCheck& check) {
  if (evaluator.fidelity().exact) return check.stationary();
  return check.relative_offset <= kCoarseOffset ||
         (!evaluator.fidelity().whole() && horizon_exhausted(problem, evaluator, check));
}

}  // namespace

std::string describe_failure(const Problem& problem, const Evaluation& evaluation) {
  for (std::size_t i = 0; i < evaluation.conditions.size(); ++i) {
    const ConditionEvaluation& each = evaluation.conditions[i];
    if (each.ok() || each.status == model::SimulationStatus::cancelled) continue;
    std::vector<std::string> values;
    for (const int j : problem.map.acting(i)) {
      const auto u = static_cast<std::size_t>(j);
      values.push_back(
          fmt::format("{} = {:g}", problem.name(u), problem.map.to_physical(j, evaluation.z[u])));
    }
    return fmt::format("condition \"{}\" cannot be simulated at {:g} s: {} ({}{}{})",
                       problem.conditions[i].condition->id, each.failed_at_s, each.reason,
                       model::to_string(each.status), values.empty() ? "" : "; ",
                       fmt::join(values, ", "));
  }
  return "not simulated";
}

std::string stop_reason(const Evaluator& evaluator, int most_iterations) {
  const std::string reason = evaluator.budget().reason();
  if (!reason.empty()) return reason;
  return fmt::format("stopped after {} iterations, the maximum, before it converged",
                     most_iterations);
}

SolveResult converged(const Iterations& iterations, const OptimumCheck& check) {
  return {FitStatus::converged, fmt::format("converged after {} iterations", iterations.total()),
          iterations.total(), check};
}

SolveResult no_start(const Problem& problem, const Evaluator& evaluator, const Evaluation& first) {
  SolveResult result;
  result.status = evaluator.budget().spent() ? FitStatus::stopped : FitStatus::failed;
  result.message = evaluator.budget().spent() ? stop_reason(evaluator, 0)
                                              : "the start " + describe_failure(problem, first);
  return result;
}

SolveResult minimise(const Problem& problem, Evaluator& evaluator, std::vector<double> z,
                     const Stage& stage, Iterations& iterations) {
  const Evaluation first = evaluator.evaluate(z);
  if (!first.ok) return no_start(problem, evaluator, first);
  const int most = stage.most_iterations == 0 ? iterations.left()
                                              : std::min(stage.most_iterations, iterations.left());
  DescentOptions options;
  options.linearise = [&](std::span<const double> at, bool) -> std::optional<Linearisation> {
    const Evaluation& there = evaluator.evaluate(at);
    if (!there.ok) return std::nullopt;
    return calib::linearise(problem, there);
  };
  options.enough = [&](const DescentStep& step) {
    iterations.tell(step.number, step.cost / problem.share_at(evaluator.fidelity()),
                    step.relative_change, step.seconds);
    return evaluator.budget().spent() ||
           near_enough(problem, evaluator, check_optimum(problem, evaluator.best()));
  };
  options.trust_radius = stage.trust_radius;
  options.most_iterations = most;
  if (!evaluator.fidelity().exact) options.function_tolerance = kCoarseChange;
  const Descent descent = descend_adaptively(options, z);
  iterations.add(descent.iterations);
  const OptimumCheck check = check_optimum(problem, evaluator.best());
  const bool at_end = !evaluator.fidelity().exact || check.is_minimum();
  if (near_enough(problem, evaluator, check) || (descent.converged && at_end))
    return converged(iterations, check);
  const std::string left = far_from_minimum(problem, evaluator.best(), check);
  if (evaluator.budget().spent() || descent.iterations >= most)
    return {FitStatus::stopped, stop_reason(evaluator, iterations.most()) + left,
            iterations.total(), check};
  return {FitStatus::failed,
          (descent.failure.empty() ? "no further step lowers the cost" : descent.failure) + left,
          iterations.total(), check};
}

}  // namespace rigcal::calib
