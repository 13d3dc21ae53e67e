#include "calib/search/growing_horizon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/search/minimise.hpp"

namespace rigcal::calib {
namespace {

/// Where samples resolve what rings, so few are less than a cycle of it. As many more for each
/// unknown that one record alone has to tell: its initial state, the offset of a sensor.
constexpr std::size_t kShortestSamples = 4;
/// How much longer each horizon is than the one before it, at most.
constexpr double kGrowth = 4.0;
/// Growth of the mean square residual beyond which the shorter horizon's estimate is discarded.
constexpr double kForeseen = 4.0;
/// Iterations at one horizon: the next one carries more information.
constexpr int kIterations = 10;

/// Up to a factor that is the same for all horizons.
double mean_square(const Evaluation& evaluation) { return evaluation.cost / evaluation.share; }

/// How many unknowns no other record tells.
std::size_t own_unknowns(const Problem& problem, std::size_t condition) {
  const std::vector<int>& acting = problem.map.acting(condition);
  return static_cast<std::size_t>(std::count_if(acting.begin(), acting.end(), [&](int j) {
    return problem.map.unknowns()[static_cast<std::size_t>(j)].scope == datasets::Scope::condition;
  }));
}

}  // namespace

std::vector<double> horizons_s(const Problem& problem) {
  double longest_s = 0.0;
  double interval_s = std::numeric_limits<double>::infinity();
  std::size_t samples = 0;
  for (std::size_t i = 0; i < problem.conditions.size(); ++i) {
    const ProblemCondition& each = problem.conditions[i];
    samples = std::max(samples, kShortestSamples * (1 + own_unknowns(problem, i)));
    const auto& time_s = each.record->time_s;
    const double last_s = time_s[each.rows[each.first_period_rows - 1]];
    longest_s = std::max(longest_s, last_s - time_s[each.rows.front()]);
    if (time_s.size() < 2) continue;
    interval_s = std::min(
        interval_s, (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1));
  }
  const double shortest_s = static_cast<double>(samples) * interval_s;
  const double growth = std::log(std::max(1.0, longest_s / shortest_s));
  const double steps = std::ceil(growth / std::log(kGrowth));
  std::vector<double> result;
  for (double k = steps; k > 0.0; --k) result.push_back(longest_s * std::exp(-growth * k / steps));
  result.push_back(longest_s);
  return result;
}

GrowingHorizon by_growing_horizon(const Problem& problem, Evaluator& evaluator,
                                  std::vector<double>& z, int iterations, int start,
                                  const FitOptions& options) {
  const std::vector<double> begin = z;
  const double begin_cost = evaluator.evaluate(z).cost;
  std::vector<double> before = z;
  double foreseen = std::numeric_limits<double>::infinity();
  const int budget = iterations / 2;  // whole records decide: the other half is theirs
  GrowingHorizon result;
  int& used = result.iterations;
  FitOptions counting = options;  // one count of iterations through all
  if (options.progress) {
    counting.progress = [&](int number, int iteration, double cost, double change, double seconds) {
      options.progress(number, used + iteration, cost, change, seconds);
    };
  }
  for (const double length_s : horizons_s(problem)) {
    evaluator.set_fidelity(Fidelity::first(length_s));
    evaluator.evaluate(z);
    // An estimate that fails at the next horizon, by more than its start does, is discarded.
    if (!evaluator.best().ok || mean_square(evaluator.best()) > kForeseen * foreseen)
      evaluator.evaluate(before);
    if (!evaluator.best().ok) break;
    z = before = evaluator.best().z;
    const int most = std::min(kIterations, budget - used);
    used += minimise(problem, evaluator, z, kFirstTrustRadius, most, start, counting).iterations;
    z = evaluator.best().z;
    result.ends.push_back(z);
    foreseen = mean_square(evaluator.best());
    if (evaluator.aborted()) return result;
    if (used >= budget) break;
  }
  evaluator.set_fidelity(Fidelity::coarse);
  const Evaluation& all = evaluator.evaluate(z);
  if (all.ok && all.cost <= begin_cost) return result;
  z = begin;
  evaluator.forget();
  evaluator.evaluate(z);
  return result;
}

}  // namespace rigcal::calib
