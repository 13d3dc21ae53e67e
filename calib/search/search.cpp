#include "calib/search/search.hpp"

#include <algorithm>
#include <limits>

namespace rigcal::calib {
namespace {

/// Full Gauss-Newton steps begin at this distance from the minimum, in standard errors; there are
/// at most kFullSteps.
constexpr double kFullStepOffset = 30.0;
constexpr int kFullSteps = 4;
/// Full steps end at this distance. It is only a third of the limit for a stationary point, because
/// each step is almost exact.
constexpr double kFullStepEnd = 0.003;
/// The step taken when simulations change from coarse to exact is rejected if the cost grows by
/// more than this factor. With large residuals a Gauss-Newton step may overshoot; the errors of the
/// coarse simulations are far smaller than that.
constexpr double kWorseStep = 1.5;
/// The estimate from a shorter horizon is discarded if the mean square residual of the next horizon
/// is larger by more than this factor.
constexpr double kForeseen = 4.0;

/// Returns the point reached by a full Gauss-Newton step.
std::vector<double> gauss_newton(const Evaluation& evaluation, const OptimumCheck& check) {
  std::vector<double> z = evaluation.z;
  for (std::size_t j = 0; j < z.size(); ++j)
    z[j] = std::clamp(z[j] + check.step(static_cast<Eigen::Index>(j)), 0.0, 1.0);
  return z;
}

/// Returns the mean square residual up to a factor that is the same for all horizons.
double mean_square(const Evaluation& evaluation) { return evaluation.cost / evaluation.share; }

}  // namespace

SolveResult Search::run(std::vector<double> z) { return run_stages(std::move(z), true); }

bool Search::approach(std::vector<double> z) {
  run_stages(std::move(z), false);
  return evaluator_.best().ok && !evaluator_.budget().spent();
}

SolveResult Search::run_stages(std::vector<double> z, bool polished) {
  evaluator_.set_fidelity(problem_.of_starts());
  ends_ = {z};
  const Evaluation first = evaluator_.evaluate(z);
  if (!first.ok) return no_start(problem_, evaluator_, first);
  z_ = begin_ = before_ = std::move(z);
  begin_cost_ = first.cost;
  foreseen_ = std::numeric_limits<double>::infinity();
  horizons_until_ = iterations_.used() + iterations_.left() / 2;  // the rest is for whole records
  SolveResult result;
  for (const Stage& stage : plan_schedule(problem_)) {
    if (stage.fidelity.exact && !polished) break;
    if (!enter(stage)) continue;
    if (stage.fidelity.exact) {
      result = polish(z_);
    } else {
      minimise(problem_, evaluator_, z_, stage, iterations_);
    }
    if (evaluator_.best().ok) z_ = evaluator_.best().z;
    ends_.push_back(z_);
    if (evaluator_.budget().spent() && !(stage.fidelity.exact && evaluator_.best().ok))
      return stopped();
    if (!evaluator_.best().ok) return no_start(problem_, evaluator_, evaluator_.evaluate(z_));
    if (stage.is_horizon()) foreseen_ = mean_square(evaluator_.best());
  }
  return result;
}

/// Sets the fidelity of a stage and the point from which it continues.
///
/// @return  false if the stage has nothing to do
bool Search::enter(const Stage& stage) {
  const bool after_horizons = foreseen_ < std::numeric_limits<double>::infinity();
  if (stage.is_horizon()) {
    if (iterations_.used() >= horizons_until_) return false;
    evaluator_.set_fidelity(stage.fidelity);
    evaluator_.evaluate(z_);
    // An estimate that fits the next horizon much worse than its own is discarded, unless the point
    // from which it started is even worse.
    if (!evaluator_.best().ok || mean_square(evaluator_.best()) > kForeseen * foreseen_)
      evaluator_.evaluate(before_);
    if (!evaluator_.best().ok) {
      horizons_until_ = 0;
      return false;
    }
    z_ = before_ = evaluator_.best().z;
    return true;
  }
  if (!stage.fidelity.exact) {
    evaluator_.set_fidelity(stage.fidelity);
    if (!after_horizons) return true;
    const Evaluation& whole = evaluator_.evaluate(z_);
    if (!whole.ok ||
        whole.cost > begin_cost_) {  // the fit to whole records is worse than at its start
      z_ = begin_;
      evaluator_.forget();
      evaluator_.evaluate(z_);
    }
    return !evaluator_.best().ok ||
           check_optimum(problem_, evaluator_.best()).relative_offset > kFullStepOffset;
  }
  // The transition from coarse simulations to simulations at the working tolerance.
  const Evaluation coarse = evaluator_.best();
  const OptimumCheck check = check_optimum(problem_, coarse);
  evaluator_.set_fidelity(stage.fidelity);
  if (check.relative_offset > kFullStepOffset) return true;
  const std::vector<double> next = gauss_newton(coarse, check);
  const Evaluation& there = evaluator_.evaluate(next);
  if (there.ok && there.cost <= kWorseStep * coarse.cost) z_ = next;
  return true;
}

SolveResult Search::polish(std::vector<double> z) {
  if (evaluator_.evaluate(z).ok && iterations_.left() > 0) {
    const OptimumCheck check = full_steps();
    if (check.is_minimum()) return converged(iterations_, check);
    z = evaluator_.best().z;
  }
  return minimise(problem_, evaluator_, std::move(z), kPolishStage, iterations_);
}

/// Takes full Gauss-Newton steps from the evaluator's best point as long as they approach a
/// stationary point. Close to it the cost is not a useful criterion, because simulation errors
/// exceed the remaining reduction. The last point becomes the evaluator's best point.
OptimumCheck Search::full_steps() {
  OptimumCheck check = check_optimum(problem_, evaluator_.best());
  const int most = std::min(kFullSteps, iterations_.left());
  for (int steps = 0; steps < most && check.relative_offset <= kFullStepOffset; ++steps) {
    if (check.relative_offset <= kFullStepEnd) break;
    const Evaluation& after = evaluator_.evaluate(gauss_newton(evaluator_.best(), check));
    if (!after.ok) break;
    const OptimumCheck found = check_optimum(problem_, after);
    if (found.relative_offset >= check.relative_offset) break;
    evaluator_.take_last();
    iterations_.add(1);
    check = found;
  }
  return check;
}

/// Returns the result of a start that was stopped before any simulation at the working tolerance:
/// the best of the end points of its stages. They are compared using coarse simulations of whole
/// records, and only the best is simulated at the working tolerance.
SolveResult Search::stopped() {
  if (evaluator_.best().ok) ends_.push_back(evaluator_.best().z);
  const std::vector<double>* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const std::vector<double>& each : ends_) {
    const Evaluation there =
        evaluate_at(problem_, each, evaluator_.threads(), {Fidelity::cost, nullptr, false});
    if (!there.ok || there.cost >= least) continue;
    best = &each;
    least = there.cost;
  }
  evaluator_.set_fidelity(Fidelity::full);
  if (best != nullptr) evaluator_.conclude(*best);
  SolveResult result{FitStatus::stopped,
                     stop_reason(evaluator_, options_.max_iterations),
                     iterations_.total(),
                     {}};
  if (evaluator_.best().ok) result.check = check_optimum(problem_, evaluator_.best());
  return result;
}

}  // namespace rigcal::calib
