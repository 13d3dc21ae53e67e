#include "calib/solve.hpp"

#include <ceres/iteration_callback.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "calib/multiple_shooting.hpp"
#include "calib/residual.hpp"
#include "calib/svd.hpp"

namespace rigcal::calib {
namespace {

constexpr int kMaxCalls = 4;
/// Ceres' own 1e4 is all but a full Gauss-Newton step: far from the optimum it ends in a corner of
/// the box, where it may stay.
constexpr double kFirstTrustRadius = 10.0;
/// Near it the full step is the right one.
constexpr double kNearTrustRadius = 1e8;
/// Standard errors that may be left of a step with coarse simulations: their own errors leave more.
constexpr double kCoarseOffset = 1.0;
/// Where full Gauss-Newton steps begin, in standard errors, and how many of them there are.
constexpr double kFullStepOffset = 30.0;
constexpr int kFullSteps = 4;
/// Where they end: a third of what counts as stationary, since each is all but exact.
constexpr double kFullStepEnd = 0.003;
/// Standard errors of a step after which nothing is simulated again: what it leaves is of the
/// second order.
constexpr double kLastStep = 0.3;
/// Relative change of the cost below which coarse simulations tell no more.
constexpr double kCoarseChange = 1e-4;

/// Whether a parameter that was held at a bound is drawn inwards now.
bool lets_go(const std::vector<bool>& held, const std::vector<bool>& now) {
  for (std::size_t j = 0; j < held.size(); ++j) {
    if (held[j] && !now[j]) return true;
  }
  return false;
}

bool near_enough(const Evaluator& evaluator, const OptimumCheck& check) {
  return evaluator.effort() == Effort::full ? check.stationary()
                                            : check.relative_offset <= kCoarseOffset;
}

/// Tells of each iteration, and ends the call at a stationary point, when the set of parameters to
/// be held at a bound has changed for good, on a signal, or at the time limit.
class Watcher final : public ceres::IterationCallback {
 public:
  Watcher(const Problem& problem, const Evaluator& evaluator, const FitOptions& options, int start,
          int first_iteration, const std::vector<bool>& held)
      : problem_(problem),
        evaluator_(evaluator),
        options_(options),
        start_(start),
        first_iteration_(first_iteration),
        held_(held) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    try {
      iterations_ = summary.iteration;
      if (options_.progress) {
        const double change = summary.cost > 0.0 ? summary.cost_change / summary.cost : 0.0;
        options_.progress(start_, first_iteration_ + summary.iteration,
                          summary.cost / problem_.share_at(evaluator_.effort()), change,
                          summary.cumulative_time_in_seconds);
      }
      const OptimumCheck check = check_optimum(problem_, evaluator_.best());
      stationary_ = near_enough(evaluator_, check);
      other_bounds_ = check.held == held_ ? 0 : other_bounds_ + 1;
      if (lets_go(held_, check.held)) other_bounds_ = kPatience;
    } catch (...) {
      error_ = std::current_exception();
    }
    const bool stop = error_ != nullptr || stationary_ || bounds_changed() || evaluator_.aborted();
    return stop ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

  int iterations() const { return iterations_; }
  bool bounds_changed() const { return other_bounds_ >= kPatience; }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  /// Iterations for which a parameter may touch a bound on its way; off it, it is let go at once.
  static constexpr int kPatience = 3;

  const Problem& problem_;
  const Evaluator& evaluator_;
  const FitOptions& options_;
  int start_;
  int first_iteration_;
  const std::vector<bool>& held_;
  int iterations_ = 0;
  int other_bounds_ = 0;
  bool stationary_ = false;
  std::exception_ptr error_;
};

/// One call of Ceres; z is where it starts and its working space.
ceres::Solver::Summary call_ceres(const Problem& problem, Evaluator& evaluator,
                                  std::vector<double>& z, const std::vector<bool>& held,
                                  double trust_radius, int iterations, Watcher& watcher,
                                  const FitOptions& options) {
  evaluator.watch(z);
  ceres::Problem::Options problem_options;
  problem_options.evaluation_callback = &evaluator;
  ceres::Problem system(problem_options);
  const auto& unknowns = problem.map.unknowns();
  for (std::size_t j = 0; j < z.size(); ++j) {
    system.AddParameterBlock(&z[j], 1);
    system.SetParameterLowerBound(&z[j], 0, 0.0);
    system.SetParameterUpperBound(&z[j], 0, 1.0);
    if (held[j]) system.SetParameterBlockConstant(&z[j]);
    if (unknowns[j].prior) {
      system.AddResidualBlock(new PriorCost(problem.map, static_cast<int>(j), *unknowns[j].prior),
                              nullptr, &z[j]);
    }
  }
  for (std::size_t i = 0; i < problem.conditions.size(); ++i) {
    std::vector<double*> blocks;
    for (const int j : problem.map.acting(i)) blocks.push_back(&z[static_cast<std::size_t>(j)]);
    if (blocks.empty()) continue;  // no unknown changes it: a constant of the cost
    system.AddResidualBlock(new ConditionCost(evaluator, i, blocks.size()), nullptr, blocks);
  }

  ceres::Solver::Options settings;
  settings.linear_solver_type = ceres::DENSE_QR;  // the triangles are small
  settings.num_threads = 1;  // more would add up in another order; conditions run in parallel
  settings.logging_type = ceres::SILENT;
  settings.minimizer_progress_to_stdout = false;
  settings.max_num_iterations = iterations;
  settings.initial_trust_region_radius = trust_radius;
  settings.function_tolerance =
      evaluator.effort() == Effort::full ? options.function_tolerance : kCoarseChange;
  settings.gradient_tolerance = options.gradient_tolerance;
  settings.parameter_tolerance = options.parameter_tolerance;
  settings.callbacks.push_back(&watcher);
  ceres::Solver::Summary summary;
  ceres::Solve(settings, &system, &summary);
  return summary;
}

std::string stop_reason(const Evaluator& evaluator, int iterations) {
  if (evaluator.cancelled()) return "stopped on request";
  if (evaluator.out_of_time()) return "stopped at the time limit";
  if (evaluator.out_of_evaluations()) {
    return fmt::format("stopped after {} evaluations, the most allowed",
                       evaluator.ledger().evaluations);
  }
  return fmt::format("stopped after {} iterations, the most allowed, before it converged",
                     iterations);
}

std::string converged_after(int iterations) {
  return fmt::format("converged after {} iterations", iterations);
}

/// The result where not even the start could be simulated.
SolveResult no_start(const Problem& problem, const Evaluator& evaluator, const Evaluation& first) {
  SolveResult result;
  result.status = evaluator.aborted() ? FitStatus::stopped : FitStatus::failed;
  result.message = evaluator.aborted() ? stop_reason(evaluator, 0)
                                       : "the start " + describe_failure(problem, first);
  return result;
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

namespace {

/// Where a full Gauss-Newton step leads, parameters that are held left where they are.
std::vector<double> gauss_newton(const Problem& problem, const Evaluation& evaluation,
                                 const std::vector<bool>& held) {
  const Linearisation system = linearise(problem, evaluation);
  std::vector<Eigen::Index> free;
  for (std::size_t j = 0; j < held.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    if (!held[j] && system.jacobian.col(column).norm() > 0.0) free.push_back(column);
  }
  std::vector<double> z = evaluation.z;
  if (free.empty()) return z;
  Eigen::MatrixXd scaled = system.jacobian(Eigen::all, free);
  const Eigen::VectorXd norms = scaled.colwise().norm();
  scaled.array().rowwise() /= norms.transpose().array();
  Svd svd(scaled, Eigen::ComputeThinU | Eigen::ComputeThinV);
  svd.setThreshold(rank_threshold(problem.tolerance));
  const Eigen::VectorXd step = -(svd.solve(system.residual).array() / norms.array()).matrix();
  for (std::size_t k = 0; k < free.size(); ++k) {
    double& each = z[static_cast<std::size_t>(free[k])];
    each = std::clamp(each + step(static_cast<Eigen::Index>(k)), 0.0, 1.0);
  }
  return z;
}

/// Full Gauss-Newton steps from the evaluator's best point while they come nearer to a stationary
/// one; near it the cost itself tells nothing, because errors of the simulation move it by more
/// than is left to gain. Where it ends is the evaluator's best point; a last short step is
/// predicted to end at a minimum, not simulated.
///
/// @return  number of steps, and what is left
std::pair<int, OptimumCheck> full_steps(const Problem& problem, Evaluator& evaluator, int most,
                                        LastStep last) {
  OptimumCheck check = check_optimum(problem, evaluator.best());
  int steps = 0;
  while (steps < most && check.relative_offset <= kFullStepOffset &&
         check.relative_offset > kFullStepEnd) {
    const std::vector<double> next = gauss_newton(problem, evaluator.best(), check.held);
    if (last == LastStep::predicted && check.relative_offset <= kLastStep) {
      Evaluation predicted = predict(problem, evaluator.best(), next);
      const OptimumCheck left = check_optimum(problem, predicted);
      if (left.relative_offset <= kFullStepEnd) {
        evaluator.take(std::move(predicted));
        return {steps + 1, left};
      }
    }
    const Evaluation& after = evaluator.evaluate(next);
    if (!after.ok) break;
    const OptimumCheck found = check_optimum(problem, after);
    if (found.relative_offset >= check.relative_offset) break;
    evaluator.take_last();
    check = found;
    ++steps;
  }
  return {steps, check};
}

/// Calls Ceres until the point is near enough to a minimum.
SolveResult descend(const Problem& problem, Evaluator& evaluator, std::vector<double> z,
                    double trust_radius, int iterations, int start, const FitOptions& options) {
  SolveResult result;
  const Evaluation first = evaluator.evaluate(z);
  if (!first.ok) return no_start(problem, evaluator, first);
  std::vector<bool> held(z.size(), false);
  int retries = 0;
  while (retries < kMaxCalls) {
    Watcher watcher(problem, evaluator, options, start, result.iterations, held);
    const auto summary = call_ceres(problem, evaluator, z, held, trust_radius,
                                    std::max(iterations - result.iterations, 0), watcher, options);
    evaluator.rethrow();
    watcher.rethrow();
    result.iterations += watcher.iterations();
    z = evaluator.best().z;
    result.check = check_optimum(problem, evaluator.best());
    const bool agreed = summary.termination_type == ceres::CONVERGENCE;
    const bool nearly = evaluator.effort() == Effort::full ? result.check.nearly_stationary()
                                                           : !lets_go(held, result.check.held);
    if (near_enough(evaluator, result.check) || (agreed && nearly)) {
      result.status = FitStatus::converged;
      result.message = converged_after(result.iterations);
      return result;
    }
    if (evaluator.aborted() || result.iterations >= iterations) {
      result.status = FitStatus::stopped;
      result.message = stop_reason(evaluator, iterations);
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
    if (!watcher.bounds_changed() || watcher.iterations() == 0) ++retries;
    trust_radius = kFirstTrustRadius;
    held = result.check.held;
    for (std::size_t j = 0; j < z.size(); ++j) {
      if (held[j]) z[j] = result.check.side[j] == BoundSide::lower ? 0.0 : 1.0;
    }
    if (!evaluator.evaluate(z).ok) break;  // not even the bound itself
  }
  return result;
}

}  // namespace

SolveResult refine(const Problem& problem, Evaluator& evaluator, std::vector<double> z,
                   int iterations, int start, const FitOptions& options, LastStep last) {
  if (!evaluator.evaluate(z).ok || iterations == 0)
    return descend(problem, evaluator, std::move(z), kNearTrustRadius, iterations, start, options);
  const auto [steps, check] =
      full_steps(problem, evaluator, std::min(kFullSteps, iterations), last);
  if (check.nearly_stationary())
    return {FitStatus::converged, converged_after(steps), steps, check};
  SolveResult result = descend(problem, evaluator, evaluator.best().z, kNearTrustRadius,
                               iterations - steps, start, options);
  result.iterations += steps;
  return result;
}

namespace {

/// Replaces a start by where multiple shooting leads, if a simulation of whole records from there
/// is the better one; half of the iterations at most.
///
/// @return  iterations that it took
int shoot(const Problem& problem, Evaluator& evaluator, std::vector<double>& z, double interval_s,
          int iterations, int start, const FitOptions& options) {
  const Evaluation first = evaluator.evaluate(z);
  const ShootingResult found =
      multiple_shooting(problem, evaluator, z, interval_s, iterations / 2, start, options);
  const Evaluation& there = evaluator.evaluate(found.z);
  if (there.ok && (!first.ok || there.cost < first.cost)) z = found.z;
  return found.iterations;
}

/// Where first periods have led.
struct Lead {
  int iterations = 0;
  bool near = false;  ///< full steps on whole records can follow
};

/// Solves with the first periods alone: what later ones repeat is not worth its time yet.
///
/// @param z  in: the start; out: where to go on from, the start itself where whole records speak
///           against what was found
Lead by_first_periods(const Problem& problem, Evaluator& evaluator, std::vector<double>& z,
                      int iterations, int start, const FitOptions& options) {
  const std::vector<double> begin = z;
  const double begin_cost = evaluator.evaluate(z).cost;
  Lead lead;
  evaluator.set_effort(Effort::first_periods);
  lead.iterations =
      descend(problem, evaluator, z, kFirstTrustRadius, iterations, start, options).iterations;
  if (evaluator.best().ok) z = evaluator.best().z;
  evaluator.set_effort(evaluator.aborted() ? Effort::full : Effort::coarse);
  const Evaluation& all = evaluator.conclude(z);
  if (!all.ok || all.cost > begin_cost) {
    z = begin;
    if (evaluator.aborted()) evaluator.conclude(z);  // the best there is
    return lead;
  }
  lead.near = check_optimum(problem, all).relative_offset <= kFullStepOffset;
  return lead;
}

/// From coarse simulations to those of the problem's tolerance.
///
/// @return  where to go on from
std::vector<double> end_coarse(const Problem& problem, Evaluator& evaluator) {
  const Evaluation coarse = evaluator.best();
  const OptimumCheck check = check_optimum(problem, coarse);
  evaluator.set_effort(Effort::full);
  if (check.relative_offset > kFullStepOffset) return coarse.z;
  const std::vector<double> next = gauss_newton(problem, coarse, check.held);
  return evaluator.evaluate(next).ok ? next : coarse.z;
}

}  // namespace

SolveResult solve(const Problem& problem, Evaluator& evaluator, std::vector<double> z,
                  int iterations, int start, const FitOptions& options) {
  evaluator.set_effort(problem.of_starts());
  int used = 0;
  FitOptions counting = options;  // one count of iterations through all
  if (options.progress) {
    counting.progress = [&](int number, int iteration, double cost, double change, double seconds) {
      options.progress(number, used + iteration, cost, change, seconds);
    };
  }
  if (const auto interval_s = problem.campaign->fit.shooting_interval_s)
    used = shoot(problem, evaluator, z, *interval_s, iterations, start, options);
  const Evaluation first = evaluator.evaluate(z);
  if (!first.ok) return no_start(problem, evaluator, first);
  bool near = false;
  if (problem.repeats_itself()) {
    const Lead lead = by_first_periods(problem, evaluator, z, iterations - used, start, counting);
    used += lead.iterations;
    near = lead.near;
  }
  if (!near && !evaluator.aborted()) {
    evaluator.set_effort(Effort::coarse);
    used += descend(problem, evaluator, z, kFirstTrustRadius, iterations - used, start, counting)
                .iterations;
  }
  if (evaluator.aborted()) {
    SolveResult stopped{FitStatus::stopped, stop_reason(evaluator, iterations), used, {}};
    if (evaluator.best().ok) stopped.check = check_optimum(problem, evaluator.best());
    return stopped;
  }
  if (!evaluator.best().ok) return no_start(problem, evaluator, evaluator.evaluate(z));

  SolveResult result = refine(problem, evaluator, end_coarse(problem, evaluator), iterations - used,
                              start, counting);
  result.iterations += used;
  if (result.status == FitStatus::converged) result.message = converged_after(result.iterations);
  if (result.status == FitStatus::stopped) result.message = stop_reason(evaluator, iterations);
  return result;
}

}  // namespace rigcal::calib
