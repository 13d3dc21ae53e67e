#include "calib/search/evaluator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/parallel.hpp"

namespace rigcal::calib {
namespace {

/// Failures that are kept in words, of each condition and kind.
constexpr int kFailuresKept = 3;

double prior_cost(const Problem& problem, std::span<const double> z) {
  double cost = 0.0;
  for (std::size_t j = 0; j < z.size(); ++j) {
    const auto& prior = problem.map.unknowns()[j].prior;
    if (!prior) continue;
    const double residual =
        (problem.map.to_physical(static_cast<int>(j), z[j]) - prior->mean) / prior->sd;
    cost += 0.5 * residual * residual;
  }
  return cost;
}

bool is_at(const Evaluation& evaluation, std::span<const double> z) {
  return std::equal(evaluation.z.begin(), evaluation.z.end(), z.begin(), z.end());
}

}  // namespace

Evaluation evaluate_at(const Problem& problem, std::span<const double> z, int threads,
                       const EvaluationOptions& options) {
  Evaluation evaluation;
  evaluation.z.assign(z.begin(), z.end());
  evaluation.conditions.resize(problem.conditions.size());
  if (options.rows != nullptr) options.rows->resize(problem.conditions.size());
  parallel_for(problem.conditions.size(), threads, [&](std::size_t i) {
    ConditionRows* const rows = options.rows != nullptr ? &(*options.rows)[i] : nullptr;
    evaluation.conditions[i] =
        options.runs != nullptr
            ? evaluate_run(problem, i, z, (*options.runs)[i], rows, options.fidelity)
            : evaluate_condition(problem, i, z, options.cancel, rows, options.fidelity);
  });
  evaluation.ok = std::all_of(evaluation.conditions.begin(), evaluation.conditions.end(),
                              [](const ConditionEvaluation& each) { return each.ok(); });
  if (!evaluation.ok) return evaluation;
  evaluation.share = problem.share_at(options.fidelity);
  evaluation.cost = prior_cost(problem, z);
  for (const ConditionEvaluation& each : evaluation.conditions) evaluation.cost += each.cost();
  return evaluation;
}

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

const Evaluation& Evaluator::evaluate(std::span<const double> z) {
  if (!last_.conditions.empty() && is_at(last_, z)) {
    keep_best();  // it may be of an earlier start
    return last_;
  }
  if (best_.ok && is_at(best_, z)) {
    last_ = best_;
    return last_;
  }
  if (aborted()) {
    last_ = {};
    last_.z.assign(z.begin(), z.end());
    last_.conditions.resize(problem_.conditions.size());
    for (ConditionEvaluation& each : last_.conditions)
      each.status = model::SimulationStatus::cancelled;
    return last_;
  }
  last_ = evaluate_now(z, options_.cancel);
  record(last_);
  keep_best();
  return last_;
}

const Evaluation& Evaluator::conclude(std::span<const double> z) {
  if (!aborted()) return evaluate(z);
  last_ = evaluate_now(z, nullptr);
  keep_best();
  return last_;
}

Evaluation Evaluator::evaluate_now(std::span<const double> z,
                                   const std::atomic<bool>* cancel) const {
  return evaluate_at(problem_, z, options_.threads, {fidelity_, cancel, nullptr});
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

bool Evaluator::cancelled() const {
  return options_.cancel != nullptr && options_.cancel->load(std::memory_order_relaxed);
}

void Evaluator::record(const Evaluation& evaluation) {
  ++counters_.evaluations;
  for (std::size_t i = 0; i < evaluation.conditions.size(); ++i) {
    const ConditionEvaluation& each = evaluation.conditions[i];
    if (each.ok() || each.status == model::SimulationStatus::cancelled) continue;
    ++counters_.failure_count;
    if (++counters_.kept[{i, each.status}] > kFailuresKept) continue;
    SimulationFailure failure;
    failure.condition = problem_.conditions[i].condition->id;
    for (const int j : problem_.map.acting(i)) {
      const auto u = static_cast<std::size_t>(j);
      failure.parameters.emplace_back(problem_.name(u),
                                      problem_.map.to_physical(j, evaluation.z[u]));
    }
    failure.time_s = each.failed_at_s;
    failure.reason = each.reason;
    failure.status = each.status;
    failure.start = start_;
    counters_.failures.push_back(std::move(failure));
  }
}

}  // namespace rigcal::calib
