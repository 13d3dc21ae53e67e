#include "calib/trust/prediction_band.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "calib/problem/day_effects.hpp"
#include "common/parallel.hpp"
#include "metrics/distributions.hpp"
#include "model/plant/parameter.hpp"
#include "model/simulate.hpp"

namespace rigcal::calib {
namespace {

/// Returns the sum of the score covariances of all conditions and of the priors, in the coordinates
/// of `root`.
ArrowMatrix long_run_covariance(const Problem& problem, std::span<const double> z,
                                const Uncertainty& uncertainty) {
  ArrowMatrix sum = uncertainty.root.zero();
  for (std::size_t i = 0; i < uncertainty.scatter.size(); ++i)
    sum.add(i, uncertainty.scatter[i].covariance);
  add_prior_information(problem, z, uncertainty.root, sum);
  return sum;
}

/// Unknowns that act in the same simulation: those of one condition together with the shared ones,
/// or only the shared ones. The rows of the matrices are in the unit box.
struct Joint {
  std::vector<std::size_t> unknowns;  ///< the condition's own unknowns come first
  std::size_t own = 0;
  Eigen::MatrixXd determined;  ///< square root of their covariance, before it is widened
  Eigen::MatrixXd open;        ///< directions that the data do not determine
};

/// @param condition   negative for the shared unknowns only
/// @param covariance  covariance of the score; if it is absent, the plain errors are used
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
  // Undetermined directions come last among the own directions and among the shared ones.
  const Eigen::MatrixXd all =
      alone ? found.covariance_root.shared() : found.covariance_root.rows(i);
  const Eigen::Index own = alone ? 0 : found.covariance_root.own_directions(i);
  const Eigen::Index open = own - (alone ? 0 : found.root.own_directions(i));
  const Eigen::Index open_shared =
      found.covariance_root.shared().cols() - found.root.shared().cols();
  joint.open.resize(all.rows(), open + open_shared);
  joint.open << all.middleCols(own - open, open), all.rightCols(open_shared);
  return joint;
}

/// Returns the largest factor by which an interval is wider than the covariance implies.
double widening(const Problem& problem, std::span<const double> z, const Uncertainty& found,
                const Joint& joint) {
  const bool robust = !found.scatter.empty();
  double widen = 1.0;
  for (std::size_t k = 0; k < joint.unknowns.size(); ++k) {
    const std::size_t u = joint.unknowns[k];
    const auto& error = robust ? found.robust_standard_error[u] : found.standard_error[u];
    const double sd = joint.determined.row(static_cast<Eigen::Index>(k)).norm();
    if (!error || !(sd > 0.0)) continue;
    const double stretched = robust && found.robust_quantile[u] > 0.0
                                 ? found.robust_quantile[u] / metrics::kNormal95
                                 : 1.0;
    const double in_box = *error / std::abs(problem.map.slope(static_cast<int>(u), z[u]));
    const double carried =
        found.known.names.empty()
            ? 0.0
            : found.known.response.row(static_cast<Eigen::Index>(u)).squaredNorm();
    widen = std::max(widen, stretched * std::sqrt(std::max(0.0, in_box * in_box - carried)) / sd);
  }
  return widen;
}

/// Returns the square root S of the full covariance of these unknowns, SI.
Eigen::MatrixXd root_of(const Problem& problem, std::span<const double> z, const Uncertainty& found,
                        const Joint& joint, double widen) {
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

/// Returns true if an estimate of the fit acts in a condition. It does not if the condition has a
/// known value of its own.
bool acts(const Problem& problem, const ProblemCondition& condition,
          const EstimateCovariance::Estimate& estimate) {
  return !known_in(*problem.campaign, *condition.condition, estimate.index) &&
         condition.condition->is_within(estimate.scope, estimate.level);
}

/// Computes the component of the residuals that the uncertainty of the estimates explains, by one
/// linear least-squares step from the estimates with their covariance as the prior.
///
/// @param gradients  for each channel, its derivatives with respect to the quantities whose
///                   covariance has the square root `root`. Shape (times, quantities)
void explain(const ProblemCondition& condition, const std::vector<Eigen::MatrixXd>& gradients,
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
        gradients[static_cast<std::size_t>(k)](counted, Eigen::all) * root / data.sd;
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
    score.explained[condition.channels[static_cast<std::size_t>(k)].channel] = {part.begin(),
                                                                                part.end()};
  }
}

/// Computes how far the prediction of each channel is open.
///
/// @param keys  of the first quantities of `gradients`
void find_open(const ProblemCondition& condition, const std::vector<Eigen::MatrixXd>& gradients,
               const Eigen::MatrixXd& root, const std::vector<std::string>& keys,
               ConditionScore& score) {
  const std::vector<Eigen::Index> counted(condition.rows.begin(), condition.rows.end());
  for (std::size_t k = 0; k < condition.channels.size(); ++k) {
    const ProblemChannel& data = condition.channels[k];
    const Eigen::Map<const Eigen::VectorXd> measured(data.measured.data(),
                                                     static_cast<Eigen::Index>(counted.size()));
    if (counted.empty() || !(measured.maxCoeff() > measured.minCoeff())) continue;
    score.open[data.channel] =
        open_prediction(gradients[k](counted, Eigen::all), root, keys, measured);
  }
}

/// Returns the number of day-to-day standard deviations by which a record may differ from those of
/// the fit. It combines the deviation on the day of the record with those on the days of the fit.
/// Returns 0 unless the dates show that the record was made on a different day.
double day_distance(const datasets::Condition& condition, const std::vector<std::string>& dates) {
  if (!is_of_another_day(condition, dates)) return 0.0;
  return std::sqrt(1.0 + 1.0 / static_cast<double>(dates.size()));
}

/// Appends columns to the gradients, and the square root of their covariance to `root`.
void append(const std::vector<Eigen::MatrixXd>& columns, const Eigen::MatrixXd& added,
            std::vector<Eigen::MatrixXd>& gradients, Eigen::MatrixXd& root) {
  Eigen::MatrixXd both =
      Eigen::MatrixXd::Zero(root.rows() + added.rows(), root.cols() + added.cols());
  both.topLeftCorner(root.rows(), root.cols()) = root;
  both.bottomRightCorner(added.rows(), added.cols()) = added;
  root = std::move(both);
  for (std::size_t k = 0; k < gradients.size(); ++k) {
    gradients[k].conservativeResize(Eigen::NoChange, root.rows());
    gradients[k].rightCols(added.rows()) = columns[k];
  }
}

void add_to(const Problem& problem, std::size_t i, std::span<const double> z,
            const EstimateCovariance& of_fit, const EffectChanges& changes, ConditionScore& score) {
  const ProblemCondition& condition = problem.conditions[i];
  const auto own = std::find_if(of_fit.own.begin(), of_fit.own.end(), [&](const auto& each) {
    return each.estimates.front().level == condition.condition->id;
  });
  std::vector<EstimateCovariance::Estimate> estimates;
  if (own != of_fit.own.end()) estimates = own->estimates;
  estimates.insert(estimates.end(), of_fit.estimates.begin(), of_fit.estimates.end());
  std::vector<int> free;
  std::vector<Eigen::Index> rows;
  for (std::size_t j = 0; j < estimates.size(); ++j) {
    const int index = estimates[j].index;
    if (!acts(problem, condition, estimates[j])) continue;
    // A value for the condition or its leak level comes later in this loop, and overrides that of
    // the rig.
    const auto same = std::find(free.begin(), free.end(), index);
    if (same == free.end()) {
      free.push_back(index);
      rows.push_back(static_cast<Eigen::Index>(j));
    } else if (estimates[j].scope != datasets::Scope::rig) {
      rows[static_cast<std::size_t>(same - free.begin())] = static_cast<Eigen::Index>(j);
    }
  }
  const double distance = day_distance(*condition.condition, of_fit.dates);
  const model::ParameterValues values = problem.values_at(i, z);
  std::vector<DayQuantity> quantities;
  std::vector<int> simulated = free;
  if (distance > 0.0 && score.time_s.size() > 1) {
    const double sample_s =
        (score.time_s.back() - score.time_s.front()) / static_cast<double>(score.time_s.size() - 1);
    quantities = day_quantities(*problem.campaign, values, sample_s);
    const std::vector<int> further = further_rows(quantities, free);
    simulated.insert(simulated.end(), further.begin(), further.end());
  }
  const model::Simulation run =
      model::simulate(condition.rig, values, simulated, condition.inputs, score.time_s,
                      condition.outputs, problem.derivative_options(i));
  if (!run.ok()) return;
  Eigen::MatrixXd root = (own != of_fit.own.end() ? own->root : of_fit.root)(rows, Eigen::all);
  std::vector<Eigen::MatrixXd> gradients;
  for (std::size_t k = 0; k < condition.channels.size(); ++k) {
    gradients.push_back(
        free.empty() ? Eigen::MatrixXd(run.outputs.rows(), 0)
                     : run.sensitivities[k].leftCols(static_cast<Eigen::Index>(free.size())));
  }
  if (!changes.empty() && changes.front().allFinite()) {
    const auto first = static_cast<Eigen::Index>(estimates.size() - of_fit.estimates.size());
    Eigen::MatrixXd moves = Eigen::MatrixXd::Zero(root.rows(), of_fit.effects.moves.cols());
    for (std::size_t j = 0; j < rows.size(); ++j) {
      if (rows[j] >= first)
        moves.row(static_cast<Eigen::Index>(j)) = of_fit.effects.moves.row(rows[j] - first);
    }
    std::vector<Eigen::MatrixXd> off;
    for (std::size_t k = 0; k < gradients.size(); ++k)
      off.push_back(changes[k] - gradients[k] * moves);
    append(off, of_fit.effects.root, gradients, root);
  }
  if (distance > 0.0) {
    std::vector<Eigen::MatrixXd> by_day;
    for (std::size_t k = 0; k < gradients.size(); ++k)
      by_day.push_back(day_changes(condition, run, static_cast<Eigen::Index>(k), simulated,
                                   score.time_s, quantities));
    const auto count = static_cast<Eigen::Index>(quantities.size());
    append(by_day, distance * Eigen::MatrixXd::Identity(count, count), gradients, root);
  }
  if (condition.condition->use != datasets::Use::fit && root.rows() > 0) {
    explain(condition, gradients, root, score);
    std::vector<std::string> keys;
    for (const int index : free) keys.emplace_back(model::parameter_spec(values.plant, index).key);
    find_open(condition, gradients, root, keys, score);
  }
  for (std::size_t k = 0; k < condition.channels.size(); ++k) {
    score.prediction_sd[condition.channels[k].channel] =
        prediction_sd(gradients[k], root, condition.channels[k].sd);
  }
}

}  // namespace

EstimateCovariance estimate_covariance(const Problem& problem, std::span<const double> z,
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
    return EstimateCovariance::Estimate{u.index, u.scope, u.level};
  };
  EstimateCovariance result;
  result.root = root_of(problem, z, found, joints.front(), widen);
  for (const std::size_t u : joints.front().unknowns) result.estimates.push_back(estimate(u));
  for (auto joint = joints.begin() + 1; joint != joints.end(); ++joint) {
    EstimateCovariance::Own& own = result.own.emplace_back();
    own.root = root_of(problem, z, found, *joint, widen);
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

OpenPrediction open_prediction(const Eigen::MatrixXd& gradient, const Eigen::MatrixXd& root,
                               const std::vector<std::string>& keys,
                               const Eigen::VectorXd& measured) {
  constexpr std::size_t kMostKeys = 3;
  constexpr double kMatters = 0.5;  // compared with the quantity that moves the prediction most
  const Eigen::MatrixXd varying = gradient.rowwise() - gradient.colwise().mean();
  const Eigen::MatrixXd moves = varying * root;
  OpenPrediction open;
  open.variance_fraction =
      moves.squaredNorm() / (measured.array() - measured.mean()).square().sum();
  if (!std::isfinite(open.variance_fraction)) return {};
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> directions(moves.transpose() * moves);
  const Eigen::VectorXd change = root * directions.eigenvectors().rightCols(1);
  std::vector<std::pair<double, std::string>> by_size;
  for (std::size_t j = 0; j < keys.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    by_size.emplace_back(varying.col(column).norm() * std::abs(change(column)), keys[j]);
  }
  std::stable_sort(by_size.begin(), by_size.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [size, key] : by_size) {
    if (open.through.size() < kMostKeys && size > 0.0 && size >= kMatters * by_size.front().first)
      open.through.push_back(key);
  }
  return open;
}

void add_prediction_sd(const Problem& problem, std::span<const double> z,
                       const EstimateCovariance& of_fit, const std::vector<EffectChanges>& changes,
                       int threads, std::vector<ConditionScore>& scores) {
  const EffectChanges none;
  parallel_for(scores.size(), threads, [&](std::size_t i) {
    if (!scores[i].failure && !scores[i].not_scored)
      add_to(problem, i, z, of_fit, changes.empty() ? none : changes[i], scores[i]);
  });
}

}  // namespace rigcal::calib
