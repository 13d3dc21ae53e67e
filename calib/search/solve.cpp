#include "calib/search/solve.hpp"

#include <algorithm>
#include <limits>

#include "calib/problem/svd.hpp"
#include "calib/search/growing_horizon.hpp"
#include "calib/search/multiple_shooting.hpp"

namespace rigcal::calib {
namespace {

/// Where full Gauss-Newton steps begin, in standard errors, and how many of them there are.
constexpr double kFullStepOffset = 30.0;
constexpr int kFullSteps = 4;
/// Where they end: a third of what counts as stationary, since each is all but exact.
constexpr double kFullStepEnd = 0.003;
/// Standard errors of a step after which nothing is simulated again: what it leaves is of the
/// second order.
constexpr double kLastStep = 0.3;
/// The same where the model leaves known noise alone: what it lacks makes a step leave a share of
/// itself.
constexpr double kLastStepOfNoise = 1.0;
/// Mean square of the weighted residuals up to which they count as noise.
constexpr double kNoise = 1.5;

/// Where a full Gauss-Newton step leads, parameters at an active bound left where they are.
std::vector<double> gauss_newton(const Problem& problem, const Evaluation& evaluation,
                                 const std::vector<bool>& active_bound) {
  const Linearisation system = linearise(problem, evaluation);
  std::vector<Eigen::Index> free;
  for (std::size_t j = 0; j < active_bound.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    if (!active_bound[j] && system.jacobian.col(column).norm() > 0.0) free.push_back(column);
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

/// Standard errors of the longest step that need not be simulated.
double longest_prediction(const Problem& problem, const Evaluation& from, LastStep last) {
  if (last == LastStep::simulated) return 0.0;
  const bool weighed =
      !problem.has_estimated_sd() && problem.campaign->fit.loss == datasets::Loss::squared;
  const double residuals = static_cast<double>(problem.residual_count());
  const bool noise = weighed && 2.0 * from.cost <= kNoise * residuals;
  return last == LastStep::judged && noise ? kLastStepOfNoise : kLastStep;
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
    const std::vector<double> next = gauss_newton(problem, evaluator.best(), check.active_bound);
    if (check.relative_offset <= longest_prediction(problem, evaluator.best(), last)) {
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

}  // namespace

SolveResult polish(const Problem& problem, Evaluator& evaluator, std::vector<double> z,
                   int iterations, int start, const FitOptions& options, LastStep last) {
  if (!evaluator.evaluate(z).ok || iterations == 0)
    return minimise(problem, evaluator, std::move(z), kNearTrustRadius, iterations, start, options);
  const auto [steps, check] =
      full_steps(problem, evaluator, std::min(kFullSteps, iterations), last);
  if (check.nearly_stationary())
    return {FitStatus::converged, converged_after(steps), steps, check};
  SolveResult result = minimise(problem, evaluator, evaluator.best().z, kNearTrustRadius,
                                iterations - steps, start, options);
  result.iterations += steps;
  return result;
}

namespace {

/// Replaces a start by where multiple shooting leads, if a simulation of whole records from there
/// is the better one; half of the iterations at most.
///
/// @return  what it found
ShootingResult shoot(const Problem& problem, Evaluator& evaluator, std::vector<double>& z,
                     double interval_s, int iterations, int start, const FitOptions& options) {
  const Evaluation first = evaluator.evaluate(z);
  ShootingResult found =
      multiple_shooting(problem, evaluator, z, interval_s, iterations / 2, start, options);
  const Evaluation& there = evaluator.evaluate(found.z);
  if (there.ok && (!first.ok || there.cost < first.cost)) z = found.z;
  return found;
}

/// From coarse simulations to those of the problem's tolerance.
///
/// @return  where to go on from
std::vector<double> end_coarse(const Problem& problem, Evaluator& evaluator) {
  const Evaluation coarse = evaluator.best();
  const OptimumCheck check = check_optimum(problem, coarse);
  evaluator.set_fidelity(Fidelity::full);
  if (check.relative_offset > kFullStepOffset) return coarse.z;
  const std::vector<double> next = gauss_newton(problem, coarse, check.active_bound);
  return evaluator.evaluate(next).ok ? next : coarse.z;
}

/// A start that was stopped before any simulation at the problem's tolerance: the best of the
/// points that its stages ended at. Whole records decide, coarsely simulated; the best alone once
/// more at that tolerance.
SolveResult stopped_at(const Problem& problem, Evaluator& evaluator,
                       std::vector<std::vector<double>> ends, int used, int iterations) {
  if (evaluator.best().ok) ends.push_back(evaluator.best().z);
  const std::vector<double>* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const std::vector<double>& each : ends) {
    const Evaluation there =
        evaluate_at(problem, each, evaluator.options().threads, {Fidelity::cost, nullptr, nullptr});
    if (!there.ok || there.cost >= least) continue;
    best = &each;
    least = there.cost;
  }
  evaluator.set_fidelity(Fidelity::full);
  if (best != nullptr) evaluator.conclude(*best);
  SolveResult stopped{FitStatus::stopped, stop_reason(evaluator, iterations), used, {}};
  if (evaluator.best().ok) stopped.check = check_optimum(problem, evaluator.best());
  return stopped;
}

}  // namespace

SolveResult solve(const Problem& problem, Evaluator& evaluator, std::vector<double> z,
                  int iterations, int start, const FitOptions& options) {
  evaluator.set_fidelity(problem.of_starts());
  int used = 0;
  FitOptions counting = options;  // one count of iterations through all
  if (options.progress) {
    counting.progress = [&](int number, int iteration, double cost, double change, double seconds) {
      options.progress(number, used + iteration, cost, change, seconds);
    };
  }
  std::vector<std::vector<double>> ends{z};  // of stages
  if (const auto interval_s = problem.campaign->fit.shooting_interval_s) {
    const ShootingResult shot =
        shoot(problem, evaluator, z, *interval_s, iterations, start, options);
    used = shot.iterations;
    ends.push_back(shot.z);
    if (evaluator.aborted()) return stopped_at(problem, evaluator, ends, used, iterations);
  }
  const Evaluation first = evaluator.evaluate(z);
  if (!first.ok) return no_start(problem, evaluator, first);
  bool near = false;
  if (problem.repeats_itself()) {
    const GrowingHorizon grown =
        by_growing_horizon(problem, evaluator, z, iterations - used, start, counting);
    used += grown.iterations;
    ends.insert(ends.end(), grown.ends.begin(), grown.ends.end());
    near = evaluator.best().ok && !evaluator.aborted() &&
           check_optimum(problem, evaluator.best()).relative_offset <= kFullStepOffset;
  }
  if (!near && !evaluator.aborted()) {
    evaluator.set_fidelity(Fidelity::coarse);
    used += minimise(problem, evaluator, z, kFirstTrustRadius, iterations - used, start, counting)
                .iterations;
  }
  if (evaluator.aborted()) return stopped_at(problem, evaluator, ends, used, iterations);
  if (!evaluator.best().ok) return no_start(problem, evaluator, evaluator.evaluate(z));

  const std::vector<double> next = end_coarse(problem, evaluator);
  SolveResult result =
      polish(problem, evaluator, next, iterations - used, start, counting, LastStep::judged);
  result.iterations += used;
  if (evaluator.aborted() && !evaluator.best().ok) {
    ends.push_back(next);
    return stopped_at(problem, evaluator, ends, result.iterations, iterations);
  }
  if (result.status == FitStatus::converged) result.message = converged_after(result.iterations);
  if (result.status == FitStatus::stopped) result.message = stop_reason(evaluator, iterations);
  return result;
}

}  // namespace rigcal::calib
