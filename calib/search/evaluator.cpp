#include "calib/search/evaluator.hpp"

#include <algorithm>

namespace rigcal::calib {
namespace {

/// Maximum number of failures described in words, for each condition and kind.
constexpr int kFailuresKept = 3;

bool is_at(const Evaluation& evaluation, std::span<const double> z) {
  return std::equal(evaluation.z.begin(), evaluation.z.end(), z.begin(), z.end());
}

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

const Evaluation& Evaluator::evaluate(std::span<const double> z) {
  if (!last_.conditions.empty() && is_at(last_, z)) {
    keep_best();  // needed because the point may be from an earlier start
    return last_;
  }
  if (best_.ok && is_at(best_, z)) {
    last_ = best_;
    return last_;
  }
  if (budget_.spent()) {
    last_ = {};
    last_.z.assign(z.begin(), z.end());
    last_.conditions.resize(problem_.conditions.size());
    for (ConditionEvaluation& each : last_.conditions)
      each.status = model::SimulationStatus::cancelled;
    return last_;
  }
  last_ = evaluate_now(z, budget_.cancel());
  record(last_);
  keep_best();
  return last_;
}

const Evaluation& Evaluator::conclude(std::span<const double> z) {
  if (!budget_.spent()) return evaluate(z);
  last_ = evaluate_now(z, nullptr);
  keep_best();
  return last_;
}

Evaluation Evaluator::evaluate_now(std::span<const double> z,
                                   const std::atomic<bool>* cancel) const {
  return evaluate_at(problem_, z, threads_, {fidelity_, cancel, keep_rows_ && fidelity_.exact});
}

void Evaluator::keep_best() {
  if (last_.ok && (!best_.ok || last_.cost < best_.cost)) best_ = last_;
}

void Evaluator::begin_start(int number) {
  start_ = number;
  best_ = {};
}

void Evaluator::begin_with(Evaluation evaluation) {
  last_ = std::move(evaluation);
  record(last_);
  keep_best();
}

void Evaluator::set_fidelity(const Fidelity& fidelity) {
  if (fidelity != fidelity_) forget();
  fidelity_ = fidelity;
}

void Evaluator::forget() {
  last_ = {};
  best_ = {};
}

void Evaluator::record(const Evaluation& evaluation) {
  counters_.record(problem_, evaluation, start_);
  budget_.count(1);
}

void Evaluator::set_counters(EvaluationCounters counters) {
  budget_.count(counters.evaluations - counters_.evaluations);
  counters_ = std::move(counters);
}

void Evaluator::add(const EvaluationCounters& counters) {
  budget_.count(counters.evaluations);
  counters_.add(counters, problem_);
}

}  // namespace rigcal::calib
