#include "calib/search/stage.hpp"

#include <algorithm>
#include <cmath>

namespace rigcal::calib {
namespace {

/// If the samples resolve an oscillation, this many of them span less than a cycle. The same number
/// is added for each unknown that only one record determines (its initial state, the offset of a
/// sensor).
constexpr std::size_t kShortestSamples = 4;
/// Maximum ratio between the lengths of successive horizons.
constexpr double kGrowth = 4.0;
/// Maximum number of iterations on one horizon; the next one contains more information.
constexpr int kHorizonIterations = 10;

/// Returns the number of unknowns that no other record determines.
std::size_t own_unknowns(const Problem& problem, std::size_t condition) {
  const std::vector<int>& acting = problem.map.acting(condition);
  return static_cast<std::size_t>(std::count_if(acting.begin(), acting.end(), [&](int j) {
    return problem.map.unknowns()[static_cast<std::size_t>(j)].scope == datasets::Scope::condition;
  }));
}

}  // namespace

std::vector<double> horizons_s(const Problem& problem) {
  double longest_s = 0.0;
  std::size_t samples = 0;
  for (std::size_t i = 0; i < problem.conditions.size(); ++i) {
    const ProblemCondition& each = problem.conditions[i];
    samples = std::max(samples, kShortestSamples * (1 + own_unknowns(problem, i)));
    const auto& time_s = each.record->time_s;
    const double last_s = time_s[each.rows[each.first_period_rows - 1]];
    longest_s = std::max(longest_s, last_s - time_s[each.rows.front()]);
  }
  const double shortest_s = static_cast<double>(samples) * problem.shortest_interval_s();
  const double growth = std::log(std::max(1.0, longest_s / shortest_s));
  const double steps = std::ceil(growth / std::log(kGrowth));
  std::vector<double> result;
  for (double k = steps; k > 0.0; --k) result.push_back(longest_s * std::exp(-growth * k / steps));
  result.push_back(longest_s);
  return result;
}

std::vector<Stage> plan_schedule(const Problem& problem) {
  std::vector<Stage> stages;
  if (problem.repeats_itself()) {
    for (const double length_s : horizons_s(problem))
      stages.push_back({Fidelity::first(length_s), kFirstTrustRadius, kHorizonIterations});
  }
  stages.push_back(kCoarseStage);
  stages.push_back(kPolishStage);
  return stages;
}

}  // namespace rigcal::calib
