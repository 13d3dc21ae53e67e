#include "diagnosis/record/leak_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>

#include "calib/consider/effect_changes.hpp"
#include "calib/problem/evaluation.hpp"
#include "calib/problem/r_factor.hpp"
#include "calib/problem/scaled_svd.hpp"
#include "calib/search/search.hpp"
#include "diagnosis/record/phase_clusters.hpp"
#include "diagnosis/record/record_share.hpp"
#include "diagnosis/record/residual_rms.hpp"
#include "diagnosis/record/steady_leak.hpp"

namespace rigcal::diagnosis {
namespace {

using datasets::Campaign;
using datasets::Condition;
using datasets::Record;

/// Maximum number of iterations. It is sufficient for one leak and a few nuisance parameters if the
/// fit starts from the best point of a scan. A fit that needs more is reported as not converged.
constexpr int kIterations = 40;
/// Minimum leak at which the effects are simulated, as a fraction of the largest coefficient in a
/// scan.
constexpr double kLeastOfLargest = 0.1;
/// Longest step of the coefficient that is taken without a simulation at its end, in standard
/// errors. A step from the average of the demo's squares of 10 Hz to a repeat, of a few standard
/// errors, is 0.06 off.
constexpr double kLinearStep = 0.01;
/// Maximum number of steps from the optimum of another record; two are usually enough.
constexpr int kStepsBeside = 4;

double leak_in(const model::ParameterValues& values, const LeakProblem& leak_problem) {
  return values.value[static_cast<std::size_t>(leak_problem.leak)];
}

void erase_value(datasets::Overrides& overrides, int index) {
  std::erase_if(overrides, [index](const auto& entry) { return entry.first == index; });
}

/// Returns the campaign's setting for the coefficient, changed such that it is estimated for every
/// record, with bounds from 0 to the largest valid value.
datasets::ParameterSetting free_leak(const Campaign& campaign, int index) {
  const auto row = static_cast<std::size_t>(index);
  const model::ParameterSpec& spec = model::parameter_table(campaign.rig.plant)[row];
  datasets::ParameterSetting setting;
  if (const auto* own = campaign.setting(index)) setting = *own;
  setting.index = index;
  setting.lower = 0.0;
  setting.upper = spec.upper;
  setting.fit = true;
  setting.scope = datasets::Scope::condition;
  setting.prior.reset();
  setting.nuisance = true;
  return setting;
}

/// Weighted residuals of a record and their derivatives at the end of the fit. The priors of the
/// unknowns are separate.
struct Linear {
  Eigen::MatrixXd jacobian;      ///< shape (residuals, unknowns), SI
  Eigen::VectorXd residual;      ///< simulated minus measured, weighted
  Eigen::VectorXd prior_weight;  ///< 1 / sd of each unknown's prior; 0 if it has no prior
  Eigen::VectorXd prior_residual;
};

void set_priors(const calib::Problem& problem, const model::ParameterValues& values,
                Linear& linear) {
  const auto& acting = problem.map.acting(0);
  linear.prior_weight = Eigen::VectorXd::Zero(linear.jacobian.cols());
  linear.prior_residual = Eigen::VectorXd::Zero(linear.jacobian.cols());
  for (std::size_t j = 0; j < acting.size(); ++j) {
    const calib::Unknown& unknown = problem.map.unknowns()[static_cast<std::size_t>(acting[j])];
    if (!unknown.prior) continue;
    const auto column = static_cast<Eigen::Index>(j);
    linear.prior_weight(column) = 1.0 / unknown.prior->sd;
    const double value = values[problem.spec(acting[j]).key];
    linear.prior_residual(column) = (value - unknown.prior->mean) / unknown.prior->sd;
  }
}

int column_of(const std::vector<int>& list, int index) {
  const auto found = std::find(list.begin(), list.end(), index);
  return found == list.end() ? -1 : static_cast<int>(found - list.begin());
}

Linear linearise(const calib::Problem& problem, const model::Simulation& run) {
  const calib::ProblemCondition& condition = problem.conditions.front();
  const auto samples = static_cast<Eigen::Index>(condition.rows.size());
  const auto channels = static_cast<Eigen::Index>(condition.channels.size());
  const auto own = static_cast<Eigen::Index>(condition.free.size());
  Eigen::MatrixXd rows(samples * channels, own + 1);
  double square_sum = 0.0;
  for (std::size_t k = 0; k < condition.channels.size(); ++k) {
    rows.middleRows(static_cast<Eigen::Index>(k) * samples, samples) =
        calib::weighted_rows(condition, k, {0, condition.rows.size()}, run,
                             Eigen::VectorXd::Ones(own), problem.campaign->fit, square_sum);
  }
  return {rows.leftCols(own), rows.col(own), {}, {}};
}

/// Returns the R factor for samples and priors. Its singular values show which combinations are
/// determined.
calib::Linearisation with_priors(const Linear& linear) {
  const Eigen::Index p = linear.jacobian.cols();
  const Eigen::Index samples = linear.jacobian.rows();
  Eigen::MatrixXd rows(samples + p, p + 1);
  rows << linear.jacobian, linear.residual,  //
      Eigen::MatrixXd(linear.prior_weight.asDiagonal()), linear.prior_residual;
  calib::RFactor r_factor(p + 1);
  r_factor.add(std::move(rows));
  return {r_factor.get().leftCols(p), r_factor.get().col(p)};
}

/// Returns the measured minus the simulated position at the samples that count [m].
std::vector<double> position_residual(const calib::ProblemCondition& condition,
                                      const Eigen::VectorXd& simulated) {
  const auto& measured = condition.record->channels.at(datasets::Channel::position).mean;
  std::vector<double> residual;
  for (const std::size_t row : condition.rows)
    residual.push_back(measured[row] - simulated(static_cast<Eigen::Index>(row)));
  return residual;
}

std::string in_words(const model::Simulation& run) {
  return fmt::format("{} at {:g} s ({})", run.reason, run.failed_at_s,
                     model::to_string(run.status));
}

/// Returns the change in the coefficient per unit of change at each sample of each channel, SI;
/// zero at samples that do not count.
///
/// @param weight  weight of each weighted residual in the coefficient, one channel after the other
std::vector<Eigen::VectorXd> weights_by_sample(const calib::ProblemCondition& condition,
                                               const Eigen::VectorXd& weight) {
  std::vector<Eigen::VectorXd> result;
  Eigen::Index next = 0;
  for (const calib::ProblemChannel& channel : condition.channels) {
    Eigen::VectorXd& own = result.emplace_back(
        Eigen::VectorXd::Zero(static_cast<Eigen::Index>(condition.record->time_s.size())));
    for (const std::size_t row : condition.rows)
      own(static_cast<Eigen::Index>(row)) = weight(next++) / channel.sd;
  }
  return result;
}

/// Computes how the quantities that differ between days change the coefficient and the position.
///
/// @param weights  see weights_by_sample()
void set_day_effects(const calib::ProblemCondition& condition, const model::Simulation& run,
                     std::size_t position, const std::vector<int>& free,
                     const std::vector<calib::DayQuantity>& quantities,
                     const std::vector<Eigen::VectorXd>& weights, LeakFit& fit) {
  if (quantities.empty()) return;
  const auto samples = static_cast<Eigen::Index>(condition.rows.size());
  const auto& times = condition.record->time_s;
  const std::vector<Eigen::Index> rows(condition.rows.begin(), condition.rows.end());
  fit.day_effects = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(quantities.size()));
  for (std::size_t k = 0; k < weights.size(); ++k) {
    fit.day_effects +=
        calib::day_changes(condition, run, static_cast<Eigen::Index>(k), free, times, quantities)
            .transpose() *
        weights[k];
  }
  const Eigen::MatrixXd of_position = calib::day_changes(
      condition, run, static_cast<Eigen::Index>(position), free, times, quantities);
  fit.day_rms_m = std::sqrt(of_position(rows, Eigen::all).squaredNorm() /
                            static_cast<double>(std::max<Eigen::Index>(1, samples)));
}

/// Returns the change in the coefficient per unit of each effect. If there is a healthy reference,
/// it already includes the changes that occur without a leak.
///
/// @param weights  see weights_by_sample()
Eigen::VectorXd moves_by_effects(const LeakEffects& effects,
                                 const std::vector<Eigen::VectorXd>& weights, double coefficient,
                                 bool has_reference) {
  Eigen::VectorXd moves = Eigen::VectorXd::Zero(effects.healthy.front().cols());
  for (std::size_t k = 0; k < weights.size(); ++k) {
    moves += std::max(0.0, coefficient) * (effects.by_leak[k].transpose() * weights[k]);
    if (!has_reference) moves += effects.healthy[k].transpose() * weights[k];
  }
  return moves;
}

/// Returns the change in the coefficient per unit of error in the parameters of the rig that are
/// not unknowns of the condition, which follow its unknowns in the runs. If there is a healthy
/// reference, it already includes the changes that occur without a leak.
///
/// @param weights  see weights_by_sample()
Eigen::VectorXd moves_by_rig(const calib::ProblemCondition& condition, const LeakRuns& runs,
                             const std::vector<Eigen::VectorXd>& weights, Eigen::Index count,
                             bool has_reference) {
  const auto own = static_cast<Eigen::Index>(condition.free.size());
  Eigen::VectorXd moves = Eigen::VectorXd::Zero(count);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    moves -= runs.leaking.sensitivities[k].middleCols(own, count).transpose() * weights[k];
    if (has_reference)
      moves += runs.healthy.sensitivities[k].middleCols(own, count).transpose() * weights[k];
  }
  return moves;
}

/// Returns the channels of the record that drive the model and are therefore not compared with it.
std::map<datasets::Channel, std::vector<double>> driving_channels(
    const calib::ProblemCondition& condition) {
  std::map<datasets::Channel, std::vector<double>> driving;
  for (const auto& [channel, series] : condition.record->channels) {
    const bool compared = std::any_of(
        condition.channels.begin(), condition.channels.end(),
        [wanted = channel](const calib::ProblemChannel& own) { return own.channel == wanted; });
    if (!compared) driving.emplace(channel, series.mean);
  }
  return driving;
}

std::vector<model::Output> outputs_and_position(const calib::ProblemCondition& condition) {
  std::vector<model::Output> outputs = condition.outputs;
  outputs.push_back(model::Output::position);
  return outputs;
}

/// Simulates a condition with the given leak.
///
/// @param rows  table rows of the parameters for which sensitivities are computed
model::Simulation simulate_with(const calib::Problem& problem, const LeakProblem& leak_problem,
                                model::ParameterValues values, double coefficient,
                                const std::vector<int>& rows, const std::atomic<bool>* cancel) {
  const calib::ProblemCondition& condition = problem.conditions.front();
  values.set(leak_problem.leak, coefficient);
  return model::simulate(condition.rig, values, rows, condition.inputs, condition.record->time_s,
                         outputs_and_position(condition), problem.simulation_options(cancel));
}

/// Runs the simulations with and without the leak at the end of a fit.
///
/// @param healthy  the simulation without the leak if there is one already, or null
LeakRuns run_both(const calib::Problem& problem, const RigFit& rig, const LeakProblem& leak_problem,
                  const model::ParameterValues& values, const model::Simulation* healthy,
                  const std::atomic<bool>* cancel) {
  const calib::ProblemCondition& condition = problem.conditions.front();
  LeakRuns runs;
  runs.values = values;
  runs.free = condition.free;
  for (const int index : rig.indices)
    if (column_of(condition.free, index) < 0) runs.free.push_back(index);
  const std::vector<int> without_days = runs.free;
  const std::vector<int> of_days = calib::further_rows(leak_problem.day_quantities, runs.free);
  runs.free.insert(runs.free.end(), of_days.begin(), of_days.end());
  const auto simulated = [&](double coefficient, const std::vector<int>& rows) {
    return simulate_with(problem, leak_problem, values, coefficient, rows, cancel);
  };
  runs.leaking = simulated(leak_in(values, leak_problem), runs.free);
  runs.healthy = healthy != nullptr ? *healthy : simulated(0.0, without_days);
  runs.time_s = condition.record->time_s;
  runs.driving = driving_channels(condition);
  runs.initial = condition.rig.initial;
  return runs;
}

/// Returns true if the simulation without the leak can be reused from another record of the
/// condition, because the values differ only in the leak.
bool serves(const LeakRuns& runs, const calib::Problem& problem, model::ParameterValues values,
            int leak) {
  const calib::ProblemCondition& condition = problem.conditions.front();
  values.set(leak, runs.values.value[static_cast<std::size_t>(leak)]);
  return runs.healthy.ok() && values.value == runs.values.value &&
         std::equal(condition.free.begin(), condition.free.end(), runs.free.begin()) &&
         runs.initial == condition.rig.initial && runs.time_s == condition.record->time_s &&
         runs.driving == driving_channels(condition);
}

/// Completes `fit`, using the simulations made at its end.
///
/// @param values  values at the end of the fit
/// @param run     simulation with these values and with sensitivities at least to the unknowns
/// @param runs    simulations of the condition with sensitivities to everything else
/// @return        step of the coefficient that the record still asks for, in standard errors
double describe(const calib::Problem& problem, const RigFit& rig, const LeakProblem& leak_problem,
                int reference, const model::ParameterValues& values, const model::Simulation& run,
                const LeakRuns& runs, const LeakEffects* effects, LeakFit& fit) {
  const int leak_row = leak_problem.leak;
  const calib::ProblemCondition& condition = problem.conditions.front();
  const model::Simulation& healthy = runs.healthy;
  const std::vector<int>& free = runs.free;
  const std::size_t position = condition.outputs.size();
  std::vector<int> rig_columns;  // covariance columns of rig parameters that are not unknowns here
  for (std::size_t j = 0; j < rig.indices.size(); ++j)
    if (column_of(condition.free, rig.indices[j]) < 0) rig_columns.push_back(static_cast<int>(j));
  if (!run.ok() || !healthy.ok()) {
    fit.failure = in_words(run.ok() ? healthy : run);
    return 0.0;
  }
  Linear linear = linearise(problem, run);
  set_priors(problem, values, linear);
  const auto leak = static_cast<Eigen::Index>(column_of(condition.free, leak_row));
  const calib::Linearisation system = with_priors(linear);
  const calib::ScaledSvd svd(system.jacobian, std::numeric_limits<double>::epsilon());
  if (svd.rank() < system.jacobian.cols()) {
    fit.failure = "no recorded signal responds to a leak";
    return 0.0;
  }
  const Eigen::VectorXd step = svd.step(system.residual);
  const Eigen::MatrixXd root = svd.root();
  const double simulated_leak = leak_in(values, leak_problem);
  fit.coefficient = simulated_leak + step(leak);
  const Eigen::MatrixXd bread = root.lazyProduct(root.transpose());
  const Eigen::VectorXd left = linear.residual + linear.jacobian * step;
  const auto [covariance, freedom] =
      cluster_sandwich(linear.jacobian, left, bread, clusters_of(condition));
  // White noise contributes to the variance of the estimate through the samples, and each prior
  // contributes with its own variance.
  const Eigen::VectorXd of_priors = linear.prior_weight.asDiagonal() * bread.col(leak);
  const double of_samples = std::max(0.0, bread(leak, leak) - of_priors.squaredNorm());
  const double noise_se =
      std::hypot(std::sqrt(of_samples) * noise_rms(std::vector<double>(left.begin(), left.end())),
                 of_priors.norm());
  fit.white_se = noise_se;
  fit.white_freedom = std::max(1, static_cast<int>(left.size() - step.size()));
  fit.cluster_se = std::sqrt(covariance(leak, leak) + of_priors.squaredNorm());
  fit.cluster_freedom = freedom;
  // The residuals also contain the noise in the mean of the healthy repeats, which does not belong
  // to the record.
  fit.noise_se = noise_se / std::sqrt(1.0 + (reference > 0 ? 1.0 / reference : 0.0));
  // The optimiser need not have converged, because the last step is taken here by linear
  // continuation, but this step must not be long. A record that is its own reference may have no
  // residual, so the error for white noise of unit variance is also an allowed length.
  const double error = std::max({fit.white_se, fit.cluster_se, root.row(leak).norm()});
  // The optimiser cannot go below zero, so only the part of the step above it is its own.
  const double own_step = step(leak) < 0.0 ? std::min(-step(leak), simulated_leak) : step(leak);
  if (simulated_leak > 0.0 && own_step > error + 1e-3 * simulated_leak) {
    fit.failure = fmt::format("the leak did not converge: a step of {:.2g} standard errors remains",
                              own_step / error);
    return own_step / error;
  }

  const std::vector<Eigen::VectorXd> weights =
      weights_by_sample(condition, linear.jacobian * bread.col(leak));
  set_day_effects(condition, runs.leaking, position, free, leak_problem.day_quantities, weights,
                  fit);
  fit.rig_moves = Eigen::VectorXd::Zero(rig.covariance.rows());
  if (effects != nullptr) {
    const Eigen::Index count = static_cast<Eigen::Index>(rig.effects.keys.size());
    fit.rig_moves.tail(count) = moves_by_effects(*effects, weights, fit.coefficient, reference > 0);
  }
  if (!rig_columns.empty())
    fit.rig_moves(rig_columns) = moves_by_rig(
        condition, runs, weights, static_cast<Eigen::Index>(rig_columns.size()), reference > 0);
  fit.rig_se = rig.error(fit.rig_moves);
  const Eigen::VectorXd effect = run.sensitivities[position].col(leak);
  double squares = 0.0;
  for (const std::size_t row : condition.rows) {
    const double each = effect(static_cast<Eigen::Index>(row));
    squares += each * each;
  }
  fit.effect_m = std::sqrt(squares / static_cast<double>(condition.rows.size()));
  const auto misfit =
      position_residual(condition, run.outputs.col(static_cast<Eigen::Index>(position)));
  fit.misfit_rms_m = rms(misfit);
  fit.noise_rms_m = noise_rms(misfit);
  fit.parity_rms_m =
      rms(position_residual(condition, healthy.outputs.col(static_cast<Eigen::Index>(position))));
  return own_step / error;
}

/// Fits a record by Gauss-Newton steps from the optimum of another record of its condition.
/// Sensitivities to what is not estimated are those of the other record.
///
/// @return  std::nullopt if the condition has other unknowns than the leak, if the records differ
///          in what is simulated, or if the steps do not converge
std::optional<LeakFit> fit_beside(const LeakRuns& runs, const calib::Problem& problem,
                                  const RigFit& rig, const LeakProblem& leak_problem, int reference,
                                  const LeakEffects* effects, const std::atomic<bool>* cancel) {
  const std::vector<double> start = problem.start();
  if (start.size() != 1 || !runs.leaking.ok() ||
      !serves(runs, problem, problem.values_at(0, start), leak_problem.leak))
    return std::nullopt;
  const Linear linear = linearise(problem, runs.leaking);
  const double curvature = linear.jacobian.squaredNorm();
  if (!(curvature > 0.0)) return std::nullopt;
  const calib::Unknown& unknown = problem.map.unknowns().front();
  double next =
      leak_in(runs.values, leak_problem) - linear.jacobian.col(0).dot(linear.residual) / curvature;
  for (int step = 0; step < kStepsBeside; ++step) {
    model::ParameterValues values = runs.values;
    values.set(leak_problem.leak, std::clamp(next, unknown.lower, unknown.upper));
    const model::Simulation run =
        simulate_with(problem, leak_problem, values, leak_in(values, leak_problem),
                      problem.conditions.front().free, cancel);
    LeakFit fit;
    const double left =
        describe(problem, rig, leak_problem, reference, values, run, runs, effects, fit);
    if (!fit.ok()) return std::nullopt;
    if (left <= kLinearStep) return fit;
    next = fit.coefficient;
  }
  return std::nullopt;
}

calib::Problem problem_of(const LeakProblem& leak_problem, const Condition& condition,
                          const std::vector<Record>& record) {
  return calib::make_problem(leak_problem.campaign, record, {&condition}, true,
                             &leak_problem.values);
}

/// Returns the condition with its windows limited to the times that the record covers.
Condition within(const Condition& condition, const Record& record,
                 const std::optional<datasets::TimeWindow>& covered) {
  Condition result = condition;
  if (!covered) return result;
  if (condition.moving_windows) result.windows = record.windows;
  result.moving_windows = false;
  if (result.windows.empty()) {
    result.windows = {*covered};
    return result;
  }
  for (datasets::TimeWindow& window : result.windows) {
    window.start_s = std::max(window.start_s, covered->start_s);
    window.end_s = std::min(window.end_s, covered->end_s);
  }
  std::erase_if(result.windows, [](const auto& window) { return window.start_s > window.end_s; });
  return result;
}

const Condition& own_condition(const LeakProblem& leak_problem, const Condition& condition) {
  return *leak_problem.campaign.find(condition.id);
}

}  // namespace

void RigFit::consider(const calib::EstimateCovariance& estimates, datasets::LeakLaw law) {
  // The leak itself is estimated, so it is not an effect that the model omits.
  const calib::EffectCovariance& all = estimates.effects;
  std::vector<Eigen::Index> kept;
  effects = {};
  for (std::size_t e = 0; e < all.keys.size(); ++e) {
    if (all.keys[e] == datasets::leak_parameter(law)) continue;
    kept.push_back(static_cast<Eigen::Index>(e));
    effects.keys.push_back(all.keys[e]);
  }
  if (kept.empty()) return;
  effects.root = all.root(kept, Eigen::all);
  const auto of_rig = static_cast<Eigen::Index>(indices.size());
  const auto count = static_cast<Eigen::Index>(kept.size());
  effects.moves = Eigen::MatrixXd::Zero(of_rig, count);
  for (Eigen::Index j = 0; j < of_rig; ++j) {
    const int index = indices[static_cast<std::size_t>(j)];
    const auto place =
        std::find_if(estimates.estimates.begin(), estimates.estimates.end(), [&](const auto& each) {
          return each.index == index && each.scope == datasets::Scope::rig;
        });
    if (place != estimates.estimates.end())
      effects.moves.row(j) = all.moves.row(place - estimates.estimates.begin())(kept);
  }
  const Eigen::MatrixXd moments = effects.root * effects.root.transpose();
  Eigen::MatrixXd both(of_rig + count, of_rig + count);
  both << covariance + effects.moves * moments * effects.moves.transpose(), effects.moves * moments,
      moments * effects.moves.transpose(), moments;
  covariance = std::move(both);
}

double RigFit::error(const Eigen::VectorXd& moves) const {
  return std::sqrt(std::max(0.0, moves.dot(covariance * moves)));
}

std::vector<calib::BudgetLine> RigFit::contributions(const Eigen::VectorXd& moves) const {
  if (covariance.rows() == 0) return {};
  const auto count = static_cast<Eigen::Index>(effects.keys.size());
  Eigen::VectorXd by_effect = Eigen::VectorXd::Zero(0);
  if (count > 0) {
    const Eigen::VectorXd through_values =
        effects.moves.transpose() * moves.head(moves.size() - count);
    by_effect = calib::variances_by_effect(moves.tail(count) + through_values,
                                           effects.root * effects.root.transpose());
  }
  const double all = error(moves);
  std::vector<calib::BudgetLine> lines{
      {"rig_parameters", "known_value", std::sqrt(std::max(0.0, all * all - by_effect.sum()))}};
  for (Eigen::Index k = 0; k < count; ++k)
    lines.push_back({effects.keys[static_cast<std::size_t>(k)], "effect", std::sqrt(by_effect(k))});
  return lines;
}

std::shared_ptr<const LeakEffects> leak_effects_of(const LeakProblem& leak_problem,
                                                   const RigFit& rig, const Condition& condition,
                                                   const Record& average, const LeakScan& scan,
                                                   HealthyEffects& healthy) {
  if (rig.effects.empty()) return nullptr;
  const std::vector<Record> records{average};
  const calib::Problem problem =
      problem_of(leak_problem, own_condition(leak_problem, condition), records);
  const calib::ProblemCondition& prepared = problem.conditions.front();
  const auto acting = calib::considered_in(problem, problem.start(), rig.effects);
  // The leak must be large enough to have a noticeable influence on the effects.
  const double leak = std::max(scan.best_coefficient, kLeastOfLargest * scan.largest_coefficient);
  if (!(leak > 0.0)) return nullptr;
  const auto values_at = [&](double coefficient) {
    model::ParameterValues values = prepared.values;
    values.set(leak_problem.leak, coefficient);
    return values;
  };
  constexpr std::array kFlows{model::Output::servo_flow, model::Output::leakage_flow};
  const auto changes_at = [&](double coefficient, std::span<const model::Output> further) {
    return calib::changes_by(problem, 0, values_at(coefficient), acting, rig.effects,
                             leak_problem.cancel, further);
  };
  auto result = std::make_shared<LeakEffects>();
  result->healthy =
      *healthy.of(prepared, values_at(0.0), acting, [&] { return changes_at(0.0, {}); });
  result->by_leak = changes_at(leak, kFlows);
  for (const calib::EffectChanges* changes : {&result->healthy, &result->by_leak}) {
    if (!std::all_of(changes->begin(), changes->end(),
                     [](const Eigen::MatrixXd& each) { return each.allFinite(); }))
      return nullptr;
  }
  // The share is computed from the flows over the record.
  model::Simulation run =
      model::simulate(prepared.rig, values_at(leak), std::vector<int>(), prepared.inputs,
                      average.time_s, kFlows, problem.simulation_options(leak_problem.cancel));
  if (!run.ok()) return nullptr;
  run.sensitivities.assign(result->by_leak.end() - kFlows.size(), result->by_leak.end());
  result->share = leak_in_record(prepared, run, 0).share_slope / leak;
  result->by_leak.resize(prepared.channels.size());
  for (std::size_t k = 0; k < result->healthy.size(); ++k)
    result->by_leak[k] = (result->by_leak[k] - result->healthy[k]) / leak;
  return result;
}

LeakProblem::LeakProblem(const Campaign& original, const RigFit& rig)
    : campaign(original),
      leak(model::parameter_index(original.rig.plant,
                                  datasets::leak_parameter(original.diagnosis.leak_law))) {
  const datasets::ParameterSetting setting = free_leak(campaign, leak);
  std::erase_if(campaign.parameters, [&](const auto& each) { return each.index == leak; });
  campaign.parameters.push_back(setting);
  for (auto& [level, overrides] : campaign.leak_levels) erase_value(overrides, leak);
  for (Condition& condition : campaign.conditions) erase_value(condition.overrides, leak);
  campaign.fit.loss = datasets::Loss::squared;
  for (const datasets::FittedValue& value : rig.values) {
    if (value.index != leak) values.push_back(value);
  }
}

LeakProblem LeakProblem::up_to(double coefficient) const {
  LeakProblem result = *this;
  datasets::ParameterSetting& setting = result.campaign.parameters.back();
  setting.upper = coefficient;
  setting.value = std::min(setting.value, coefficient);
  return result;
}

LeakProblem LeakProblem::corrected_by(int reference, int repeats) const {
  LeakProblem result = *this;
  for (datasets::ParameterSetting& setting : result.campaign.parameters) {
    if (setting.between_repeats && reference > 0)
      setting.prior->sd *= std::sqrt(1.0 + static_cast<double>(repeats) / reference);
  }
  return result;
}

LeakFit fit_leak(const LeakProblem& leak_problem, const RigFit& rig, const Condition& condition,
                 const Record& record, const std::optional<datasets::TimeWindow>& covered,
                 int reference, const LeakScan* scan, const std::atomic<bool>* cancel,
                 const LeakEffects* effects, std::optional<LeakRuns>* healthy) {
  LeakFit fit;
  const Condition counted = within(own_condition(leak_problem, condition), record, covered);
  const std::vector<Record> records{record};
  const calib::Problem problem = problem_of(leak_problem, counted, records);
  if (healthy != nullptr && *healthy) {
    if (const auto beside =
            fit_beside(**healthy, problem, rig, leak_problem, reference, effects, cancel))
      return *beside;
  }
  calib::Budget budget(cancel);
  calib::Evaluator evaluator(problem, budget);
  std::vector<double> z = problem.start();
  for (std::size_t j = 0; j < z.size(); ++j) {
    if (scan != nullptr && problem.map.unknowns()[j].index == leak_problem.leak)
      z[j] = problem.map.to_unit(static_cast<int>(j), scan->best_coefficient);
  }
  calib::FitOptions settings;
  settings.max_iterations = kIterations;
  const calib::SolveResult solved = calib::Search(problem, evaluator, settings).run(z);
  const calib::Evaluation& best = evaluator.best();
  if (!best.ok || evaluator.budget().spent()) {
    fit.failure = solved.message;
    return fit;
  }
  const model::ParameterValues values = problem.values_at(0, best.z);
  const bool known =
      healthy != nullptr && *healthy && serves(**healthy, problem, values, leak_problem.leak);
  LeakRuns found =
      run_both(problem, rig, leak_problem, values, known ? &(*healthy)->healthy : nullptr, cancel);
  describe(problem, rig, leak_problem, reference, values, found.leaking, found, effects, fit);
  if (healthy != nullptr && !*healthy) *healthy = std::move(found);
  return fit;
}

LeakScan leak_scan_of(const LeakProblem& leak_problem, const Condition& condition,
                      const Record& average) {
  const std::vector<Record> records{average};
  const calib::Problem problem =
      problem_of(leak_problem, own_condition(leak_problem, condition), records);
  const double beyond = 1.3 * leak_problem.campaign.diagnosis.limits.back();
  return scan_leaks(problem, problem.conditions.front(), beyond, leak_problem.cancel);
}

namespace {

/// Returns the leak of a condition as a function of the coefficient, with slopes by what the memo
/// keeps. `problem` must outlive it.
auto leaks_of(const LeakProblem& leak_problem, const calib::Problem& problem, LeakMemo& memo) {
  std::vector<int> free = memo.further();
  if (column_of(free, leak_problem.leak) < 0) free.push_back(leak_problem.leak);
  const auto simulated = [&leak_problem, &problem, &memo, free](double coefficient,
                                                                PeriodicEffort least) {
    const calib::ProblemCondition& condition = problem.conditions.front();
    model::ParameterValues values = condition.values;
    values.set(leak_problem.leak, coefficient);
    const SteadyLeak leak =
        steady_leak(problem, condition, values, free, leak_problem.cancel, least);
    const int own = column_of(free, leak_problem.leak);
    return SimulatedLeak{LeakPoint{coefficient, leak.share, leak.leak_flow_m3_per_s,
                                   leak.share_slope(own), leak.flow_slope(own)},
                         leak.share_slope.head(static_cast<Eigen::Index>(memo.further().size())),
                         leak.effort};
  };
  return [&memo, simulated](double coefficient) { return memo.at(coefficient, simulated); };
}

}  // namespace

LeakCurve leak_curve_of(const LeakProblem& leak_problem, const Condition& condition,
                        const Record& average, double coefficient, double reach, LeakMemo& memo) {
  const std::vector<Record> records{average};
  const calib::Problem problem =
      problem_of(leak_problem, own_condition(leak_problem, condition), records);
  const auto leak_at = leaks_of(leak_problem, problem, memo);
  return curve_about([&](double each) { return leak_at(each).point; }, coefficient, reach);
}

LeakPoint leak_point_of(const LeakProblem& leak_problem, const Condition& condition,
                        const Record& average, double coefficient, double reach, LeakMemo& memo) {
  const std::vector<Record> records{average};
  const calib::Problem problem =
      problem_of(leak_problem, own_condition(leak_problem, condition), records);
  const auto leak_at = leaks_of(leak_problem, problem, memo);
  return point_about([&](double each) { return leak_at(each).point; }, coefficient, reach);
}

Eigen::VectorXd share_rig_moves(const LeakProblem& leak_problem, const RigFit& rig,
                                const Condition& condition, const Record& average,
                                const LeakFit& fit, double share_slope, LeakMemo& memo,
                                double negligible, const LeakEffects* effects) {
  if (memo.further() != rig.indices)
    throw std::invalid_argument("share_rig_moves: expected a memo with the rig's parameters");
  if (rig.covariance.rows() == 0) return Eigen::VectorXd::Zero(0);
  Eigen::VectorXd moves = share_slope * fit.rig_moves;
  const auto of_rig = static_cast<Eigen::Index>(rig.indices.size());
  if (effects != nullptr && effects->share.size() == moves.size() - of_rig)
    moves.tail(moves.size() - of_rig) -= std::max(0.0, fit.coefficient) * effects->share;
  if (of_rig > 0 && fit.coefficient > negligible) {  // otherwise the share is zero for any rig
    const std::vector<Record> records{average};
    const calib::Problem problem =
        problem_of(leak_problem, own_condition(leak_problem, condition), records);
    moves.head(of_rig) += leaks_of(leak_problem, problem, memo)(fit.coefficient).further_slope;
  }
  return moves;
}

Eigen::VectorXd share_day_effects(const LeakProblem& leak_problem, const Condition& condition,
                                  const Record& average, const LeakFit& fit, double share_slope,
                                  LeakMemo& memo, double negligible) {
  Eigen::VectorXd moves = share_slope * fit.day_effects;
  if (!(fit.coefficient > negligible) || moves.size() == 0) return moves;
  const std::vector<Record> records{average};
  const calib::Problem problem =
      problem_of(leak_problem, own_condition(leak_problem, condition), records);
  const Eigen::VectorXd slopes =
      leaks_of(leak_problem, problem, memo)(fit.coefficient).further_slope;
  const bool supply_recorded = problem.conditions.front().inputs.supply_pressure_pa.has_value();
  for (std::size_t q = 0; q < leak_problem.day_quantities.size(); ++q) {
    const calib::DayQuantity& quantity = leak_problem.day_quantities[q];
    const int place = column_of(memo.further(), quantity.index);
    if (place < 0 || (supply_recorded && quantity.quantity == "supply_pressure")) continue;
    moves(static_cast<Eigen::Index>(q)) += quantity.sd * slopes(place);
  }
  return moves;
}

Residuals healthy_residuals(const LeakProblem& leak_problem, const Condition& condition,
                            const Record& average, const std::vector<const Record*>& records) {
  const std::vector<Record> averages{average};
  const calib::Problem problem =
      problem_of(leak_problem, own_condition(leak_problem, condition), averages);
  const calib::ProblemCondition& prepared = problem.conditions.front();
  model::ParameterValues values = prepared.values;
  values.set(leak_problem.leak, 0.0);
  const auto healthy =
      model::simulate(prepared.rig, values, {}, prepared.inputs, average.time_s, prepared.outputs,
                      problem.simulation_options(leak_problem.cancel));
  if (!healthy.ok())
    throw NoResultError(
        fmt::format("condition \"{}\": healthy model: {}", condition.id, in_words(healthy)));
  Residuals result;
  for (const Record* record : records) {
    auto& channels = result.emplace_back();
    for (std::size_t k = 0; k < prepared.channels.size(); ++k) {
      const datasets::Channel channel = prepared.channels[k].channel;
      std::vector<double> residual = record->channels.at(channel).mean;
      for (std::size_t i = 0; i < residual.size(); ++i)
        residual[i] -= healthy.outputs(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
      channels.emplace(channel, std::move(residual));
    }
  }
  return result;
}

Eigen::MatrixXd healthy_day_changes(const LeakProblem& leak_problem, const Condition& condition,
                                    const Record& average) {
  const std::vector<Record> averages{average};
  const calib::Problem problem =
      problem_of(leak_problem, own_condition(leak_problem, condition), averages);
  const calib::ProblemCondition& prepared = problem.conditions.front();
  model::ParameterValues values = prepared.values;
  values.set(leak_problem.leak, 0.0);
  const std::vector<int> rows = calib::further_rows(leak_problem.day_quantities, {});
  const auto run = model::simulate(prepared.rig, values, rows, prepared.inputs, average.time_s,
                                   std::vector{model::Output::position},
                                   problem.simulation_options(leak_problem.cancel));
  if (!run.ok())
    throw NoResultError(
        fmt::format("condition \"{}\": healthy model: {}", condition.id, in_words(run)));
  return calib::day_changes(prepared, run, 0, rows, average.time_s, leak_problem.day_quantities);
}

double share_at(const Campaign& campaign, const Condition& condition, const Record& record,
                const std::vector<datasets::FittedValue>& values, const std::atomic<bool>* cancel) {
  const std::vector<Record> records{record};
  calib::Problem problem = calib::make_problem(campaign, records, {&condition}, true, nullptr);
  calib::ProblemCondition& prepared = problem.conditions.front();
  for (const datasets::FittedValue& value : values) {
    const bool here = value.scope == datasets::Scope::rig ||
                      value.level == (value.scope == datasets::Scope::condition
                                          ? condition.id
                                          : condition.leak_level.value_or(""));
    if (here) prepared.values.set(value.index, value.value);
  }
  return steady_leak(problem, prepared, prepared.values, {}, cancel).share;
}

}  // namespace rigcal::diagnosis
