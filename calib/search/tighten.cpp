#include "calib/search/tighten.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace rigcal::calib {
namespace {

constexpr int kFinerRounds = 2;
constexpr double kFiner = 0.1;
constexpr double kFinestTolerance = 1e-9;
/// Standard errors left of the way: farther off something else is wrong.
constexpr double kNearby = 1.0;

}  // namespace

bool tighten_tolerance(Problem& problem, Evaluator& evaluator, const FitOptions& options,
                       MultiStart& found) {
  for (int round = 0; round < kFinerRounds; ++round) {
    const bool stalled = found.optimum.ok && found.result.status == FitStatus::failed &&
                         found.result.check.relative_offset <= kNearby;
    if (!stalled || problem.tolerance_fixed || evaluator.aborted()) return round > 0;
    problem.tolerance = std::max(kFiner * problem.tolerance, kFinestTolerance);
    evaluator.forget();
    const int before = found.result.iterations;
    SolveResult result =
        polish(problem, evaluator, found.optimum.z, options.max_iterations, found.best, options);
    if (!evaluator.best().ok) return true;
    result.iterations += before;
    if (result.status == FitStatus::converged)
      result.message = fmt::format("converged after {} iterations", result.iterations);
    found.result = result;
    found.optimum = evaluator.best();
    report_best(problem, found);
  }
  return true;
}

}  // namespace rigcal::calib
