#include "calib/problem/evaluation.hpp"

#include <algorithm>
#include <cmath>

#include "calib/problem/loss.hpp"
#include "calib/problem/r_factor.hpp"
#include "common/parallel.hpp"

namespace rigcal::calib {
namespace {

/// Close to the optimum, derivatives may be less accurate than the outputs by this factor. With the
/// factor used elsewhere, their errors would shift the gradient by a hundredth of a standard error
/// or more if the residual is pure noise (decision 0004).
constexpr double kLoosenessNearOptimum = 10.0;

double prior_cost(const Problem& problem, std::span<const double> z) {
  double cost = 0.0;
  for (std::size_t j = 0; j < z.size(); ++j) {
    const double residual = problem.map.prior_residual(static_cast<int>(j), z[j]);
    cost += 0.5 * residual * residual;
  }
  return cost;
}

/// Returns the rows of a condition and of the priors on its own unknowns. The columns are its own
/// unknowns, the shared unknowns and the residual.
///
/// @param column  for each shared unknown, its column among the shared ones
Eigen::MatrixXd condition_rows(const Problem& problem, const Evaluation& evaluation, std::size_t i,
                               const std::vector<int>& own, const std::vector<Eigen::Index>& column,
                               Eigen::Index shared) {
  const Eigen::MatrixXd& part = evaluation.conditions[i].r_factor;
  const auto first = static_cast<Eigen::Index>(own.size());
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(part.rows() + first, first + shared + 1);
  const std::vector<int>& acting = problem.map.acting(i);
  for (std::size_t j = 0; j < acting.size(); ++j) {
    const auto mine = std::find(own.begin(), own.end(), acting[j]);
    const Eigen::Index at = mine != own.end() ? mine - own.begin()
                                              : first + column[static_cast<std::size_t>(acting[j])];
    rows.col(at).head(part.rows()) = part.col(static_cast<Eigen::Index>(j));
  }
  rows.col(first + shared).head(part.rows()) = part.col(part.cols() - 1);
  for (Eigen::Index k = 0; k < first; ++k) {
    const int unknown = own[static_cast<std::size_t>(k)];
    const double at = evaluation.z[static_cast<std::size_t>(unknown)];
    rows(part.rows() + k, k) = problem.map.prior_slope(unknown, at);
    rows(part.rows() + k, first + shared) = problem.map.prior_residual(unknown, at);
  }
  return rows;
}

}  // namespace

Eigen::MatrixXd weighted_rows(const ProblemCondition& condition, std::size_t channel,
                              const RowRange& range, const model::Simulation& run,
                              const Eigen::VectorXd& slopes, const datasets::FitSettings& settings,
                              double& square_sum) {
  const ProblemChannel& data = condition.channels[channel];
  const auto column = static_cast<Eigen::Index>(channel);
  const Eigen::Index unknowns = slopes.size();
  const auto count = static_cast<Eigen::Index>(range.end - range.begin);
  const bool squared = settings.loss == datasets::Loss::squared;
  const Eigen::Map<const Eigen::VectorXd> measured(data.measured.data() + range.begin, count);
  Eigen::MatrixXd rows(count, unknowns + 1);
  const auto fill = [&](const auto& samples) {
    const Eigen::VectorXd error = run.outputs(samples, column) - measured;
    square_sum += error.squaredNorm();
    Eigen::VectorXd weight = Eigen::VectorXd::Constant(count, 1.0 / data.sd);
    rows.col(unknowns) = error / data.sd;
    for (Eigen::Index row = 0; row < count && !squared; ++row) {
      const LossValue loss = apply_loss(settings.loss, settings.loss_scale, rows(row, unknowns));
      weight(row) *= loss.slope;
      rows(row, unknowns) = loss.residual;
    }
    for (Eigen::Index j = 0; j < unknowns; ++j) {
      rows.col(j) = run.sensitivities[channel](samples, j).cwiseProduct(weight) * slopes(j);
    }
  };
  if (count == 0) return rows;
  const auto first = static_cast<Eigen::Index>(condition.rows[range.begin]);
  if (condition.rows[range.end - 1] - condition.rows[range.begin] + 1 == range.end - range.begin) {
    fill(Eigen::seqN(first, count));  // without gaps, Eigen can use vector registers
  } else {
    std::vector<Eigen::Index> samples;
    for (std::size_t i = range.begin; i < range.end; ++i)
      samples.push_back(static_cast<Eigen::Index>(condition.rows[i]));
    fill(samples);
  }
  return rows;
}

Eigen::VectorXd acting_slopes(const Problem& problem, std::size_t condition,
                              std::span<const double> z) {
  const std::vector<int>& acting = problem.map.acting(condition);
  Eigen::VectorXd slopes(static_cast<Eigen::Index>(acting.size()));
  for (std::size_t j = 0; j < acting.size(); ++j) {
    slopes(static_cast<Eigen::Index>(j)) =
        problem.map.slope(acting[j], z[static_cast<std::size_t>(acting[j])]);
  }
  return slopes;
}

model::SimulationOptions simulation_options(const Problem& problem, std::size_t condition,
                                            double tolerance, const std::atomic<bool>* cancel) {
  model::SimulationOptions options = problem.simulation_options(cancel);
  options.tolerance = tolerance;
  options.max_steps = problem.conditions[condition].max_steps;
  return options;
}

model::Simulation simulate_condition(const Problem& problem, std::size_t condition,
                                     std::span<const double> z, const std::atomic<bool>* cancel,
                                     const Fidelity& fidelity) {
  const ProblemCondition& data = problem.conditions[condition];
  auto options =
      simulation_options(problem, condition, problem.tolerance_of(condition, fidelity), cancel);
  if (fidelity.exact) options.sensitivity_looseness = kLoosenessNearOptimum;
  return model::simulate(data.rig, problem.values_at(condition, z),
                         fidelity.derivatives ? data.free : std::vector<int>(), data.inputs,
                         data.fit_times(fidelity), data.outputs, options);
}

ConditionEvaluation evaluate_condition(const Problem& problem, std::size_t condition,
                                       std::span<const double> z, const std::atomic<bool>* cancel,
                                       ConditionRows* rows, const Fidelity& fidelity) {
  return evaluate_run(problem, condition, z,
                      simulate_condition(problem, condition, z, cancel, fidelity), rows, fidelity);
}

ConditionEvaluation evaluate_run(const Problem& problem, std::size_t condition,
                                 std::span<const double> z, const model::Simulation& run,
                                 ConditionRows* rows, const Fidelity& fidelity) {
  const ProblemCondition& data = problem.conditions[condition];
  const datasets::Campaign& campaign = *problem.campaign;
  const bool slopes_too = fidelity.derivatives;
  ConditionEvaluation result;
  result.status = run.status;
  result.steps = run.steps + run.rejected_steps;
  result.failed_at_s = run.failed_at_s;
  result.reason = run.reason;
  if (!run.ok()) return result;

  const Eigen::VectorXd slopes =
      slopes_too ? acting_slopes(problem, condition, z) : Eigen::VectorXd();
  const Eigen::Index unknowns = slopes.size();
  const std::size_t count = data.rows_at(fidelity);
  const auto samples = static_cast<Eigen::Index>(count);
  if (rows != nullptr) {
    const Eigen::Index total = samples * static_cast<Eigen::Index>(data.channels.size());
    rows->jacobian.resize(total, unknowns);
    rows->residual.resize(total);
  }
  RFactor r_factor(unknowns + 1);
  for (std::size_t k = 0; k < data.channels.size(); ++k) {
    double square_sum = 0.0;
    for (std::size_t begin = 0; begin < count; begin += RFactor::kBlock) {
      const std::size_t end = std::min(begin + RFactor::kBlock, count);
      Eigen::MatrixXd weighted =
          weighted_rows(data, k, {begin, end}, run, slopes, campaign.fit, square_sum);
      if (rows != nullptr) {
        const Eigen::Index first =
            static_cast<Eigen::Index>(k) * samples + static_cast<Eigen::Index>(begin);
        rows->jacobian.middleRows(first, weighted.rows()) = weighted.leftCols(unknowns);
        rows->residual.segment(first, weighted.rows()) = weighted.col(unknowns);
      }
      r_factor.add(std::move(weighted));
    }
    result.rms.push_back(std::sqrt(square_sum / static_cast<double>(samples)));
  }
  result.r_factor = r_factor.get();
  if (!result.r_factor.allFinite()) {
    result.status = model::SimulationStatus::not_finite;
    result.failed_at_s = data.fit_times(fidelity).back();
    result.reason = "a residual or its derivative is not finite";
    result.r_factor.resize(0, 0);
  }
  return result;
}

Evaluation evaluate_at(const Problem& problem, std::span<const double> z, int threads,
                       const EvaluationOptions& options) {
  Evaluation evaluation;
  evaluation.z.assign(z.begin(), z.end());
  evaluation.conditions.resize(problem.conditions.size());
  if (options.rows) {
    evaluation.rows = std::make_shared<std::vector<ConditionRows>>(problem.conditions.size());
  }
  parallel_for(problem.conditions.size(), threads, [&](std::size_t i) {
    ConditionRows* const rows = options.rows ? &(*evaluation.rows)[i] : nullptr;
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

Linearisation linearise(const Problem& problem, const Evaluation& evaluation) {
  const ArrowLayout& layout = problem.map.layout();
  const auto shared = static_cast<Eigen::Index>(layout.shared.size());
  std::vector<Eigen::Index> column(problem.map.unknowns().size(), -1);
  for (Eigen::Index k = 0; k < shared; ++k)
    column[static_cast<std::size_t>(layout.shared[static_cast<std::size_t>(k)])] = k;
  RFactor total(shared + 1);
  Linearisation result;
  for (std::size_t i = 0; i < evaluation.conditions.size(); ++i) {
    const bool alone = layout.own.empty() || layout.own[i].empty();
    const std::vector<int> own = alone ? std::vector<int>() : layout.own[i];
    Eigen::MatrixXd rows = condition_rows(problem, evaluation, i, own, column, shared);
    const auto first = static_cast<Eigen::Index>(own.size());
    if (first > 0) {
      RFactor turned(rows.cols());
      turned.add(std::move(rows));
      rows = turned.get();
    }
    total.add(rows.bottomRightCorner(rows.rows() - first, shared + 1));
    if (layout.own.empty()) continue;
    result.own.push_back({own, rows.topLeftCorner(first, first),
                          rows.block(0, first, first, shared),
                          rows.col(rows.cols() - 1).head(first)});
  }
  for (Eigen::Index k = 0; k < shared; ++k) {
    const int unknown = layout.shared[static_cast<std::size_t>(k)];
    const auto u = static_cast<std::size_t>(unknown);
    if (!problem.map.unknowns()[u].prior) continue;
    Eigen::MatrixXd row = Eigen::MatrixXd::Zero(1, shared + 1);
    row(0, k) = problem.map.prior_slope(unknown, evaluation.z[u]);
    row(0, shared) = problem.map.prior_residual(unknown, evaluation.z[u]);
    total.add(row);
  }
  result.jacobian = total.get().leftCols(shared);
  result.residual = total.get().col(shared);
  result.shared = layout.shared;
  return result;
}

}  // namespace rigcal::calib
