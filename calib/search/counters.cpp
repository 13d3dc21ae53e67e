#include "calib/search/counters.hpp"

#include <algorithm>

namespace rigcal::calib {
namespace {

/// Maximum number of failures described in words, for each condition and kind.
constexpr int kFailuresKept = 3;

}  // namespace

void EvaluationCounters::add(const EvaluationCounters& later, const Problem& problem) {
  evaluations += later.evaluations;
  failure_count += later.failure_count;
  std::map<std::pair<std::size_t, model::SimulationStatus>, int> seen = kept;
  for (const SimulationFailure& failure : later.failures) {
    const auto at = std::find_if(
        problem.conditions.begin(), problem.conditions.end(),
        [&](const ProblemCondition& each) { return each.condition->id == failure.condition; });
    const auto index = static_cast<std::size_t>(at - problem.conditions.begin());
    if (++seen[{index, failure.status}] <= kFailuresKept) failures.push_back(failure);
  }
  for (const auto& [kind, count] : later.kept) kept[kind] += count;
}

void EvaluationCounters::record(const Problem& problem, const Evaluation& evaluation, int start) {
  ++evaluations;
  for (std::size_t i = 0; i < evaluation.conditions.size(); ++i) {
    const ConditionEvaluation& each = evaluation.conditions[i];
    if (each.ok() || each.status == model::SimulationStatus::cancelled) continue;
    ++failure_count;
    if (++kept[{i, each.status}] > kFailuresKept) continue;
    SimulationFailure failure;
    failure.condition = problem.conditions[i].condition->id;
    for (const int j : problem.map.acting(i)) {
      const auto u = static_cast<std::size_t>(j);
      failure.parameters.emplace_back(problem.name(u), problem.map.to_physical(j, evaluation.z[u]));
    }
    failure.time_s = each.failed_at_s;
    failure.reason = each.reason;
    failure.status = each.status;
    failure.start = start;
    failures.push_back(std::move(failure));
  }
}

}  // namespace rigcal::calib
