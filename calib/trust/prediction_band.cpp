#include "calib/trust/prediction_band.hpp"

#include <algorithm>
#include <cmath>

#include "common/parallel.hpp"
#include "model/simulate.hpp"

namespace rigcal::calib {
namespace {

constexpr double kHalf95 = 1.96;

/// Sum of the covariances of all conditions and of the priors, in coordinates of `root`.
Eigen::MatrixXd long_run_covariance(const Problem& problem, std::span<const double> z,
                                    const Uncertainty& uncertainty) {
  const Eigen::MatrixXd& root = uncertainty.root;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(root.cols(), root.cols());
  for (const ScoreScatter& each : uncertainty.scatter) sum += each.covariance;
  add_prior_information(problem, z, root, sum);
  return sum;
}

/// Whether an estimate of the fit acts in a condition that has no known value of its own.
bool acts(const Problem& problem, const ProblemCondition& condition,
          const EstimateSpread::Estimate& estimate) {
  if (known_in(*problem.campaign, *condition.condition, estimate.index)) return false;
  switch (estimate.scope) {
    case datasets::Scope::rig:
      return true;
    case datasets::Scope::leak_level:
      return condition.condition->leak_level.value_or("") == estimate.level;
    case datasets::Scope::condition:
      return condition.condition->id == estimate.level;
  }
  return false;
}

void add_to(const Problem& problem, std::size_t i, std::span<const double> z,
            const EstimateSpread& spread, ConditionScore& score) {
  const ProblemCondition& condition = problem.conditions[i];
  std::vector<int> free;
  std::vector<Eigen::Index> rows;
  for (std::size_t j = 0; j < spread.estimates.size(); ++j) {
    const int index = spread.estimates[j].index;
    if (!acts(problem, condition, spread.estimates[j])) continue;
    // A value of the condition or level replaces that of the rig, and comes after it here.
    const auto same = std::find(free.begin(), free.end(), index);
    if (same == free.end()) {
      free.push_back(index);
      rows.push_back(static_cast<Eigen::Index>(j));
    } else if (spread.estimates[j].scope != datasets::Scope::rig) {
      rows[static_cast<std::size_t>(same - free.begin())] = static_cast<Eigen::Index>(j);
    }
  }
  const model::Simulation run =
      model::simulate(condition.rig, problem.values_at(i, z), free, condition.inputs, score.time_s,
                      condition.outputs, problem.simulation_options());
  if (!run.ok()) return;
  const Eigen::MatrixXd root = spread.root(rows, Eigen::all);
  for (std::size_t k = 0; k < condition.channels.size(); ++k) {
    const Eigen::MatrixXd gradient =
        free.empty() ? Eigen::MatrixXd(run.outputs.rows(), 0)
                     : run.sensitivities[k].leftCols(static_cast<Eigen::Index>(free.size()));
    score.prediction_sd[condition.channels[k].channel] =
        prediction_sd(gradient, root, condition.channels[k].sd);
  }
}

}  // namespace

EstimateSpread estimate_spread(const Problem& problem, std::span<const double> z,
                               const Uncertainty& uncertainty) {
  const auto n = static_cast<Eigen::Index>(z.size());
  const Eigen::Index rank = uncertainty.root.cols();
  const bool robust = !uncertainty.scatter.empty();
  Eigen::MatrixXd determined =
      robust ? Eigen::MatrixXd(uncertainty.root *
                               square_root(long_run_covariance(problem, z, uncertainty)))
             : Eigen::MatrixXd(std::sqrt(std::max(1.0, uncertainty.reduced_chi_square)) *
                               uncertainty.root);
  const bool known = !uncertainty.known.names.empty();
  const Eigen::MatrixXd carried = known ? uncertainty.known.response : Eigen::MatrixXd::Zero(n, 0);
  double widen = 1.0;
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto u = static_cast<std::size_t>(j);
    const auto& error =
        robust ? uncertainty.robust_standard_error[u] : uncertainty.standard_error[u];
    const double sd = determined.row(j).norm();
    if (!error || !(sd > 0.0)) continue;
    const double stretched = robust && uncertainty.robust_quantile[u] > 0.0
                                 ? uncertainty.robust_quantile[u] / kHalf95
                                 : 1.0;
    const double in_box = *error / std::abs(problem.map.slope(static_cast<int>(j), z[u]));
    const double own =
        std::sqrt(std::max(0.0, in_box * in_box - (known ? carried.row(j).squaredNorm() : 0.0)));
    widen = std::max(widen, stretched * own / sd);
  }
  determined *= widen;

  EstimateSpread result;
  result.root.resize(n, determined.cols() + carried.cols() + n - rank);
  result.root << determined, carried, uncertainty.spread.rightCols(n - rank);
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto u = static_cast<std::size_t>(j);
    const Unknown& unknown = problem.map.unknowns()[u];
    result.estimates.push_back({unknown.index, unknown.scope, unknown.level});
    result.root.row(j) *= problem.map.slope(static_cast<int>(j), z[u]);
  }
  return result;
}

std::vector<double> prediction_sd(const Eigen::MatrixXd& gradient, const Eigen::MatrixXd& root,
                                  double noise_sd) {
  Eigen::VectorXd variance = Eigen::VectorXd::Constant(gradient.rows(), noise_sd * noise_sd);
  if (gradient.cols() > 0) variance += (gradient * root).rowwise().squaredNorm();
  const Eigen::VectorXd sd = variance.cwiseSqrt();
  return {sd.begin(), sd.end()};
}

void add_prediction_sd(const Problem& problem, std::span<const double> z,
                       const EstimateSpread& spread, int threads,
                       std::vector<ConditionScore>& scores) {
  parallel_for(scores.size(), threads, [&](std::size_t i) {
    if (scores[i].failure.empty() && scores[i].not_scored.empty())
      add_to(problem, i, z, spread, scores[i]);
  });
}

}  // namespace rigcal::calib
