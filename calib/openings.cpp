#include "calib/openings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/descend.hpp"

namespace rigcal::calib {
namespace {

/// Where samples resolve what rings, so few are less than a cycle of it.
constexpr double kShortestSamples = 4.0;
/// How much longer each opening is than the one before it, at most.
constexpr double kGrowth = 4.0;
/// A mean square residual so many times that of the opening before it was not foreseen.
constexpr double kForeseen = 4.0;

double mean_square(const Problem& problem, const Evaluator& evaluator) {
  return evaluator.best().cost / problem.share_at(evaluator.effort());
}

}  // namespace

std::vector<double> opening_lengths_s(const Problem& problem) {
  double longest_s = 0.0;
  double interval_s = std::numeric_limits<double>::infinity();
  for (const ProblemCondition& each : problem.conditions) {
    const auto& time_s = each.record->time_s;
    const double last_s = time_s[each.rows[each.first_period_rows - 1]];
    longest_s = std::max(longest_s, last_s - time_s[each.rows.front()]);
    if (time_s.size() < 2) continue;
    interval_s = std::min(
        interval_s, (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1));
  }
  const double growth = std::log(std::max(1.0, longest_s / (kShortestSamples * interval_s)));
  const double steps = std::ceil(growth / std::log(kGrowth));
  std::vector<double> result;
  for (double k = steps; k > 0.0; --k) result.push_back(longest_s * std::exp(-growth * k / steps));
  result.push_back(longest_s);
  return result;
}

int by_openings(const Problem& problem, Evaluator& evaluator, std::vector<double>& z,
                int iterations, int start, const FitOptions& options) {
  const std::vector<double> begin = z;
  const double begin_cost = evaluator.evaluate(z).cost;
  std::vector<double> before = z;
  double foreseen = std::numeric_limits<double>::infinity();
  int used = 0;
  FitOptions counting = options;  // one count of iterations through all
  if (options.progress) {
    counting.progress = [&](int number, int iteration, double cost, double change, double seconds) {
      options.progress(number, used + iteration, cost, change, seconds);
    };
  }
  for (const double length_s : opening_lengths_s(problem)) {
    evaluator.set_effort(Effort::opening(length_s));
    evaluator.evaluate(z);
    // What fits an opening and fails in the next one, worse than where it came from, is forgotten.
    if (!evaluator.best().ok || mean_square(problem, evaluator) > kForeseen * foreseen)
      evaluator.evaluate(before);
    if (!evaluator.best().ok) break;
    z = before = evaluator.best().z;
    used += descend(problem, evaluator, z, kFirstTrustRadius, iterations - used, start, counting)
                .iterations;
    z = evaluator.best().z;
    foreseen = mean_square(problem, evaluator);
    if (evaluator.aborted() || used >= iterations) break;
  }
  evaluator.set_effort(evaluator.aborted() ? Effort::full : Effort::coarse);
  const Evaluation& all = evaluator.conclude(z);
  if (all.ok && all.cost <= begin_cost) return used;
  z = begin;
  evaluator.forget();
  evaluator.conclude(z);
  return used;
}

}  // namespace rigcal::calib
