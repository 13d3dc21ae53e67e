#include "calib/trust/prediction_band.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "common/parallel.hpp"
#include "model/simulate.hpp"

namespace rigcal::calib {
namespace {

constexpr double kHalf95 = 1.96;

/// Sum of the covariances of all conditions and of the priors, in coordinates of `root`.
ArrowMatrix long_run_covariance(const Problem& problem, std::span<const double> z,
                                const Uncertainty& uncertainty) {
  ArrowMatrix sum = uncertainty.root.zero();
  for (std::size_t i = 0; i < uncertainty.scatter.size(); ++i)
    sum.add(i, uncertainty.scatter[i].covariance);
  add_prior_information(problem, z, uncertainty.root, sum);
  return sum;
}

/// Unknowns that a simulation may know together: those of a condition with the shared ones, or
/// these alone. Rows are in the unit box.
struct Joint {
  std::vector<std::size_t> unknowns;  ///< own ones first
  std::size_t own = 0;
  Eigen::MatrixXd determined;  ///< S of their covariance, before it is widened
  Eigen::MatrixXd open;        ///< directions that the data do not determine
};

/// @param condition   negative: the shared ones alone
/// @param covariance  of the score; none: the plain errors count
Joint joint_of(const Uncertainty& found, int condition,
               const std::optional<ArrowMatrix>& covariance) {
  const bool alone = condition < 0;
  const auto i = static_cast<std::size_t>(std::max(0, condition));
  Joint joint;
  for (Eigen::Index j = 0; j < found.root.unknowns() && !alone; ++j) {
    if (found.root.condition_of(j) == condition)
      joint.unknowns.push_back(static_cast<std::size_t>(j));
  }
  joint.own = joint.unknowns.size();
  for (Eigen::Index j = 0; j < found.root.unknowns(); ++j) {
    if (found.root.condition_of(j) < 0) joint.unknowns.push_back(static_cast<std::size_t>(j));
  }
  const Eigen::MatrixXd root = alone ? found.root.shared() : found.root.rows(i);
  joint.determined =
      covariance
          ? Eigen::MatrixXd(root * square_root(alone ? covariance->shared : covariance->of(i)))
          : Eigen::MatrixXd(std::sqrt(std::max(1.0, found.reduced_chi_square)) * root);
  // What is not determined comes last among the own directions and among the shared ones.
  const Eigen::MatrixXd spread = alone ? found.spread.shared() : found.spread.rows(i);
  const Eigen::Index own = alone ? 0 : found.spread.own_directions(i);
  const Eigen::Index open = own - (alone ? 0 : found.root.own_directions(i));
  const Eigen::Index open_shared = found.spread.shared().cols() - found.root.shared().cols();
  joint.open.resize(spread.rows(), open + open_shared);
  joint.open << spread.middleCols(own - open, open), spread.rightCols(open_shared);
  return joint;
}

/// The most by which an interval is wider than by the covariance.
double widening(const Problem& problem, std::span<const double> z, const Uncertainty& found,
                const Joint& joint) {
  const bool robust = !found.scatter.empty();
  double widen = 1.0;
  for (std::size_t k = 0; k < joint.unknowns.size(); ++k) {
    const std::size_t u = joint.unknowns[k];
    const auto& error = robust ? found.robust_standard_error[u] : found.standard_error[u];
    const double sd = joint.determined.row(static_cast<Eigen::Index>(k)).norm();
    if (!error || !(sd > 0.0)) continue;
    const double stretched =
        robust && found.robust_quantile[u] > 0.0 ? found.robust_quantile[u] / kHalf95 : 1.0;
    const double in_box = *error / std::abs(problem.map.slope(static_cast<int>(u), z[u]));
    const double carried =
        found.known.names.empty()
            ? 0.0
            : found.known.response.row(static_cast<Eigen::Index>(u)).squaredNorm();
    widen = std::max(widen, stretched * std::sqrt(std::max(0.0, in_box * in_box - carried)) / sd);
  }
  return widen;
}

/// S of the covariance of all that is uncertain of them, SI.
Eigen::MatrixXd spread_of(const Problem& problem, std::span<const double> z,
                          const Uncertainty& found, const Joint& joint, double widen) {
  const auto n = static_cast<Eigen::Index>(joint.unknowns.size());
  const Eigen::Index determined = joint.determined.cols();
  const Eigen::Index carried = found.known.names.empty() ? 0 : found.known.response.cols();
  Eigen::MatrixXd root(n, determined + carried + joint.open.cols());
  root.leftCols(determined) = widen * joint.determined;
  root.rightCols(joint.open.cols()) = joint.open;
  for (Eigen::Index k = 0; k < n; ++k) {
    const std::size_t u = joint.unknowns[static_cast<std::size_t>(k)];
    if (carried > 0)
      root.row(k).segment(determined, carried) =
          found.known.response.row(static_cast<Eigen::Index>(u));
    root.row(k) *= problem.map.slope(static_cast<int>(u), z[u]);
  }
  return root;
}

/// Whether an estimate of the fit acts in a condition, known values of its own aside.
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

/// Sets what the uncertainty of the estimates explains of the residuals: a step of linear least
/// squares from the estimates, whose covariance is the prior.
void explain(const ProblemCondition& condition, const model::Simulation& run, Eigen::Index free,
             const Eigen::MatrixXd& root, ConditionScore& score) {
  const std::vector<Eigen::Index> counted(condition.rows.begin(), condition.rows.end());
  const auto samples = static_cast<Eigen::Index>(counted.size());
  const auto channels = static_cast<Eigen::Index>(condition.channels.size());
  if (samples == 0 || score.channels.size() != condition.channels.size()) return;
  Eigen::MatrixXd effects(channels * samples, root.cols());
  Eigen::VectorXd residual(channels * samples);
  for (Eigen::Index k = 0; k < channels; ++k) {
    const ProblemChannel& data = condition.channels[static_cast<std::size_t>(k)];
    const auto own = Eigen::seqN(k * samples, samples);
    effects(own, Eigen::all) =
        run.sensitivities[static_cast<std::size_t>(k)].leftCols(free)(counted, Eigen::all) * root /
        data.sd;
    const std::vector<double>& simulated = score.series.at(data.channel).second;
    const Eigen::Map<const Eigen::VectorXd> whole(simulated.data(),
                                                  static_cast<Eigen::Index>(simulated.size()));
    const Eigen::Map<const Eigen::VectorXd> measured(data.measured.data(), samples);
    residual(own) = (measured - whole(counted)) / data.sd;
  }
  Eigen::MatrixXd normal = effects.transpose() * effects;
  normal.diagonal().array() += 1.0;
  const Eigen::VectorXd explained = effects * normal.llt().solve(effects.transpose() * residual);
  if (!explained.allFinite()) return;
  for (Eigen::Index k = 0; k < channels; ++k) {
    const double sd = condition.channels[static_cast<std::size_t>(k)].sd;
    const Eigen::VectorXd part = sd * explained.segment(k * samples, samples);
    score.channels[static_cast<std::size_t>(k)].explained = {part.begin(), part.end()};
  }
}

void add_to(const Problem& problem, std::size_t i, std::span<const double> z,
            const EstimateSpread& spread, ConditionScore& score) {
  const ProblemCondition& condition = problem.conditions[i];
  const auto own = std::find_if(spread.own.begin(), spread.own.end(), [&](const auto& each) {
    return each.estimates.front().level == condition.condition->id;
  });
  std::vector<EstimateSpread::Estimate> estimates;
  if (own != spread.own.end()) estimates = own->estimates;
  estimates.insert(estimates.end(), spread.estimates.begin(), spread.estimates.end());
  std::vector<int> free;
  std::vector<Eigen::Index> rows;
  for (std::size_t j = 0; j < estimates.size(); ++j) {
    const int index = estimates[j].index;
    if (!acts(problem, condition, estimates[j])) continue;
    // A value of the condition or level goes before that of the rig: it stands behind it here.
    const auto same = std::find(free.begin(), free.end(), index);
    if (same == free.end()) {
      free.push_back(index);
      rows.push_back(static_cast<Eigen::Index>(j));
    } else if (estimates[j].scope != datasets::Scope::rig) {
      rows[static_cast<std::size_t>(same - free.begin())] = static_cast<Eigen::Index>(j);
    }
  }
  const model::Simulation run =
      model::simulate(condition.rig, problem.values_at(i, z), free, condition.inputs, score.time_s,
                      condition.outputs, problem.derivative_options(i));
  if (!run.ok()) return;
  const Eigen::MatrixXd root =
      (own != spread.own.end() ? own->root : spread.root)(rows, Eigen::all);
  if (condition.condition->use != datasets::Use::fit && !free.empty())
    explain(condition, run, static_cast<Eigen::Index>(free.size()), root, score);
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
                               const Uncertainty& found) {
  std::optional<ArrowMatrix> covariance;
  if (!found.scatter.empty()) covariance = long_run_covariance(problem, z, found);
  std::vector<Joint> joints{joint_of(found, -1, covariance)};
  for (int i = 0; i < static_cast<int>(problem.conditions.size()); ++i) {
    if (found.root.own_unknowns(static_cast<std::size_t>(i)) > 0)
      joints.push_back(joint_of(found, i, covariance));
  }
  double widen = 1.0;
  for (const Joint& joint : joints) widen = std::max(widen, widening(problem, z, found, joint));
  const auto estimate = [&](std::size_t unknown) {
    const Unknown& u = problem.map.unknowns()[unknown];
    return EstimateSpread::Estimate{u.index, u.scope, u.level};
  };
  EstimateSpread result;
  result.root = spread_of(problem, z, found, joints.front(), widen);
  for (const std::size_t u : joints.front().unknowns) result.estimates.push_back(estimate(u));
  for (auto joint = joints.begin() + 1; joint != joints.end(); ++joint) {
    EstimateSpread::Own& own = result.own.emplace_back();
    own.root = spread_of(problem, z, found, *joint, widen);
    for (std::size_t k = 0; k < joint->own; ++k)
      own.estimates.push_back(estimate(joint->unknowns[k]));
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
