#include "calib/search/minimise.hpp"

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>
#include <ceres/iteration_callback.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <span>

#include "calib/search/prior_cost.hpp"

namespace rigcal::calib {
namespace {

constexpr int kMaxCalls = 4;
/// Standard errors that may be left of a step with coarse simulations: their own errors leave more.
constexpr double kCoarseOffset = 1.0;
/// Share of the cost that may be left to gain in a horizon: the model then errs by a fraction of
/// what it leaves anyway.
constexpr double kHorizonLeaves = 0.05;
/// Standard errors that may be left with it: in many samples a parameter that is far off, but acts
/// on few of them, is a small share of the cost.
constexpr double kHorizonOffset = 10.0;
/// Relative change of the cost below which coarse simulations tell no more.
constexpr double kCoarseChange = 1e-4;

/// Ceres ends at these at the latest; our own measure of a minimum is checked before
/// (OptimumCheck).
constexpr double kGradientTolerance = 1e-10;
constexpr double kParameterTolerance = 1e-9;

/// Whether a parameter that was at an active bound is drawn inwards now.
bool lets_go(const std::vector<bool>& active_bound, const std::vector<bool>& now) {
  for (std::size_t j = 0; j < active_bound.size(); ++j) {
    if (active_bound[j] && !now[j]) return true;
  }
  return false;
}

/// Whether a horizon carries no more information: the next one, a few times as long, has far more.
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

/// Evaluates all conditions once for each point that Ceres tries; its cost functions read them.
/// Nothing may be thrown through Ceres: what is thrown ends the call and is thrown again after it.
class Trials final : public ceres::EvaluationCallback {
 public:
  Trials(Evaluator& evaluator, std::span<const double> z) : evaluator_(evaluator), z_(z) {}

  void PrepareForEvaluation(bool /*jacobians*/, bool /*new_point*/) override {
    try {
      last_ = &evaluator_.evaluate(z_);
    } catch (...) {
      error_ = std::current_exception();
      last_ = nullptr;
    }
  }

  /// Of a condition; null where it could not be simulated.
  const Eigen::MatrixXd* r_factor(std::size_t condition) const {
    if (last_ == nullptr || !last_->conditions[condition].ok()) return nullptr;
    return &last_->conditions[condition].r_factor;
  }
  bool failed() const { return error_ != nullptr; }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  Evaluator& evaluator_;
  std::span<const double> z_;
  const Evaluation* last_ = nullptr;
  std::exception_ptr error_;
};

/// Residuals of one condition for Ceres: its R factor. One parameter block of size 1 per acting
/// unknown, in that order. Borrows the trials.
class ConditionCost final : public ceres::CostFunction {
 public:
  ConditionCost(const Trials& trials, std::size_t condition, std::size_t acting)
      : trials_(trials), condition_(condition) {
    set_num_residuals(static_cast<int>(acting) + 1);
    mutable_parameter_block_sizes()->assign(acting, 1);
  }

  /// False where the condition could not be simulated: Ceres then shortens its step.
  bool Evaluate(double const* const* /*parameters*/, double* residuals,
                double** jacobians) const override {
    const Eigen::MatrixXd* const r_factor = trials_.r_factor(condition_);
    if (r_factor == nullptr) return false;
    const Eigen::Index rows = r_factor->rows();
    Eigen::Map<Eigen::VectorXd>(residuals, rows) = r_factor->col(rows - 1);
    if (jacobians == nullptr) return true;
    for (Eigen::Index j = 0; j + 1 < rows; ++j) {
      if (jacobians[j] != nullptr)
        Eigen::Map<Eigen::VectorXd>(jacobians[j], rows) = r_factor->col(j);
    }
    return true;
  }

 private:
  const Trials& trials_;
  std::size_t condition_;
};

/// Tells of each iteration, and ends the call at a stationary point, when the set of parameters to
/// be fixed at a bound has changed for good, on a signal, or at the time limit.
class Watcher final : public ceres::IterationCallback {
 public:
  Watcher(const Problem& problem, const Evaluator& evaluator, const Trials& trials,
          const Iterations& iterations, const std::vector<bool>& active_bound)
      : problem_(problem),
        evaluator_(evaluator),
        trials_(trials),
        iterations_(iterations),
        active_bound_(active_bound) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    try {
      made_ = summary.iteration;
      iterations_.tell(made_, summary.cost / problem_.share_at(evaluator_.fidelity()),
                       summary.cost > 0.0 ? summary.cost_change / summary.cost : 0.0,
                       summary.cumulative_time_in_seconds);
      const OptimumCheck check = check_optimum(problem_, evaluator_.best());
      stationary_ = near_enough(problem_, evaluator_, check);
      other_bounds_ = check.active_bound == active_bound_ ? 0 : other_bounds_ + 1;
      if (lets_go(active_bound_, check.active_bound)) other_bounds_ = kPatience;
    } catch (...) {
      error_ = std::current_exception();
    }
    const bool stop = error_ != nullptr || trials_.failed() || stationary_ || bounds_changed() ||
                      evaluator_.aborted();
    return stop ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

  int made() const { return made_; }
  bool bounds_changed() const { return other_bounds_ >= kPatience; }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  /// Iterations for which a parameter may touch a bound on its way; off it, it is let go at once.
  static constexpr int kPatience = 3;

  const Problem& problem_;
  const Evaluator& evaluator_;
  const Trials& trials_;
  const Iterations& iterations_;
  const std::vector<bool>& active_bound_;
  int made_ = 0;
  int other_bounds_ = 0;
  bool stationary_ = false;
  std::exception_ptr error_;
};

/// One call of Ceres.
///
/// @param z  where it starts, and its working space, which the trials read
ceres::Solver::Summary call_ceres(const Problem& problem, const Fidelity& fidelity, Trials& trials,
                                  std::vector<double>& z, const std::vector<bool>& active_bound,
                                  double trust_radius, int iterations, Watcher& watcher) {
  ceres::Problem::Options problem_options;
  problem_options.evaluation_callback = &trials;
  ceres::Problem system(problem_options);
  const auto& unknowns = problem.map.unknowns();
  for (std::size_t j = 0; j < z.size(); ++j) {
    system.AddParameterBlock(&z[j], 1);
    system.SetParameterLowerBound(&z[j], 0, 0.0);
    system.SetParameterUpperBound(&z[j], 0, 1.0);
    if (active_bound[j]) system.SetParameterBlockConstant(&z[j]);
    if (unknowns[j].prior) {
      system.AddResidualBlock(new PriorCost(problem.map, static_cast<int>(j), *unknowns[j].prior),
                              nullptr, &z[j]);
    }
  }
  for (std::size_t i = 0; i < problem.conditions.size(); ++i) {
    std::vector<double*> blocks;
    for (const int j : problem.map.acting(i)) blocks.push_back(&z[static_cast<std::size_t>(j)]);
    if (blocks.empty()) continue;  // no unknown changes it: a constant of the cost
    system.AddResidualBlock(new ConditionCost(trials, i, blocks.size()), nullptr, blocks);
  }

  ceres::Solver::Options settings;
  settings.linear_solver_type = ceres::DENSE_QR;  // the R factors are small
  settings.num_threads = 1;  // more would add up in another order; conditions run in parallel
  settings.logging_type = ceres::SILENT;
  settings.minimizer_progress_to_stdout = false;
  settings.max_num_iterations = iterations;
  settings.initial_trust_region_radius = trust_radius;
  settings.function_tolerance = fidelity.exact ? kFunctionTolerance : kCoarseChange;
  settings.gradient_tolerance = kGradientTolerance;
  settings.parameter_tolerance = kParameterTolerance;
  settings.callbacks.push_back(&watcher);
  ceres::Solver::Summary summary;
  ceres::Solve(settings, &system, &summary);
  return summary;
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
  if (evaluator.cancelled()) return "stopped on request";
  if (evaluator.out_of_time()) return "stopped at the time limit";
  if (evaluator.out_of_evaluations()) {
    return fmt::format("stopped after {} evaluations, the most allowed",
                       evaluator.counters().evaluations);
  }
  return fmt::format("stopped after {} iterations, the most allowed, before it converged",
                     most_iterations);
}

SolveResult converged(const Iterations& iterations, const OptimumCheck& check) {
  return {FitStatus::converged, fmt::format("converged after {} iterations", iterations.total()),
          iterations.total(), check};
}

SolveResult no_start(const Problem& problem, const Evaluator& evaluator, const Evaluation& first) {
  SolveResult result;
  result.status = evaluator.aborted() ? FitStatus::stopped : FitStatus::failed;
  result.message = evaluator.aborted() ? stop_reason(evaluator, 0)
                                       : "the start " + describe_failure(problem, first);
  return result;
}

SolveResult minimise(const Problem& problem, Evaluator& evaluator, std::vector<double> z,
                     const Stage& stage, Iterations& iterations) {
  const Evaluation first = evaluator.evaluate(z);
  if (!first.ok) return no_start(problem, evaluator, first);
  const int most = stage.most_iterations == 0 ? iterations.left()
                                              : std::min(stage.most_iterations, iterations.left());
  const int end = iterations.used() + most;
  double trust_radius = stage.trust_radius;
  std::vector<bool> active_bound(z.size(), false);
  SolveResult result;
  int retries = 0;
  while (retries < kMaxCalls) {
    Trials trials(evaluator, z);
    Watcher watcher(problem, evaluator, trials, iterations, active_bound);
    const auto summary = call_ceres(problem, evaluator.fidelity(), trials, z, active_bound,
                                    trust_radius, end - iterations.used(), watcher);
    trials.rethrow();
    watcher.rethrow();
    iterations.add(watcher.made());
    result.iterations = iterations.total();
    z = evaluator.best().z;
    result.check = check_optimum(problem, evaluator.best());
    const bool agreed = summary.termination_type == ceres::CONVERGENCE;
    const bool nearly = evaluator.fidelity().exact
                            ? result.check.nearly_stationary()
                            : !lets_go(active_bound, result.check.active_bound);
    if (near_enough(problem, evaluator, result.check) || (agreed && nearly))
      return converged(iterations, result.check);
    if (evaluator.aborted() || iterations.used() >= end) {
      result.status = FitStatus::stopped;
      result.message = stop_reason(evaluator, iterations.most());
      return result;
    }
    result.status = FitStatus::failed;
    result.message =
        summary.termination_type == ceres::FAILURE
            ? "the optimiser gave up: " + summary.message
            : fmt::format(
                  "the optimiser says that it converged, but a step of {:.2g} standard "
                  "errors is left: not a minimum",
                  result.check.relative_offset);
    if (!watcher.bounds_changed() || watcher.made() == 0) ++retries;
    trust_radius = kFirstTrustRadius;
    active_bound = result.check.active_bound;
    for (std::size_t j = 0; j < z.size(); ++j) {
      if (active_bound[j]) z[j] = result.check.side[j] == BoundSide::lower ? 0.0 : 1.0;
    }
    if (!evaluator.evaluate(z).ok) break;  // not even the bound itself
  }
  return result;
}

}  // namespace rigcal::calib
