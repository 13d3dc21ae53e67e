#include "calib/consider/consider.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "calib/consider/catalogue.hpp"
#include "calib/consider/refit.hpp"
#include "calib/consider/truncated_normal.hpp"
#include "calib/problem/measured_tolerance.hpp"
#include "calib/trust/between_repeats.hpp"
#include "calib/trust/identifiability.hpp"
#include "calib/trust/lack_of_fit.hpp"
#include "common/parallel.hpp"
#include "metrics/distributions.hpp"
#include "metrics/significance.hpp"

namespace rigcal::calib {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The records do not determine a direction if they contain less than this fraction of the priors'
/// information about it.
constexpr double kLeastInformation = 1e-6;
/// Significance level for all tests for missing effects together. With the right model, one fit in
/// fifty proposes an effect.
constexpr double kMissingLevel = 0.02;
/// Significance level of the tests for unexplained error, for all records together (Bonferroni).
constexpr double kUnexplainedLevel = 0.01;
/// Two sizes share a secant if their logarithms differ by less than this.
constexpr double kSameSize = 0.5;
/// Maximum number of chord iterations, and the step at which they have converged, in standard
/// errors for white noise.
constexpr int kMostChords = 12;
constexpr double kSettledMove = 0.3;
/// Fraction of an estimate beyond which a move that an effect causes is not linear: its square is a
/// tenth of the 20 % at which an interval is asymmetric.
constexpr double kFarMove = 0.05;
/// Maximum number of times that secants are recomputed.
constexpr int kMostSecants = 2;
/// Maximum number of missing effects to name; more than this would be a guess.
constexpr std::size_t kMostMissing = 3;
/// Maximum number of effects that are refitted individually. A refit is worthwhile if the effect
/// explains at least kWorthRefitting times as much as the best one.
constexpr std::size_t kMostCandidates = 8;
constexpr double kWorthRefitting = 0.2;
/// Factor by which a score test may misjudge the size of an effect.
constexpr double kMistakenSize = 3.0;
/// Size at which the refit of an additional effect starts, as a multiple of its plausible size.
constexpr double kFirstSize = 0.3;

/// Effects, with the changes in the estimates and residuals that they cause. All sizes are in units
/// of the plausible size.
struct Seen {
  std::vector<Effect> effects;
  MatrixXd taken;  ///< C: the change in the estimates for which the fit mistakes each effect, shape
                   ///< (all directions of the root, effects)
  MatrixXd left;   ///< M
  VectorXd score;  ///< s
  MatrixXd basis;  ///< T: left = T^-T T^-1 on the directions that the records determine
  /// Columns Q with Q^T Q = 1, which span the part of the effects that the fit has not absorbed,
  /// and the residual without the effects.
  std::vector<ScoreRows> rows;
};

/// The change that each effect causes in the rows of a condition, shape (channels * samples,
/// effects). Together these matrices take more memory than anything else in a fit, and are
/// therefore stored in single precision.
using EffectColumns = Eigen::MatrixXf;

/// Removes effects that cannot be simulated, and records the reason.
void drop_failed(std::vector<Effect>& effects, std::vector<EffectColumns>& columns,
                 std::vector<ConsideredEffect>& dropped) {
  std::vector<Index> kept;
  std::vector<Effect> remaining;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const auto column = static_cast<Index>(e);
    const bool finite = std::all_of(columns.begin(), columns.end(), [&](const EffectColumns& each) {
      return each.col(column).allFinite();
    });
    if (finite) {
      kept.push_back(column);
      remaining.push_back(std::move(effects[e]));
    } else {
      effects[e].about.problem = "the records cannot be simulated with it";
      dropped.push_back(std::move(effects[e].about));
    }
  }
  effects = std::move(remaining);
  for (EffectColumns& each : columns) each = EffectColumns(each(Eigen::all, kept));
}

/// Returns the rows of `taken` for the directions of a condition.
MatrixXd taken_in(std::size_t condition, const Uncertainty& found, const Seen& seen) {
  return seen.taken(found.root.directions(condition), Eigen::all);
}

/// Computes the changes that the effects cause in the estimates and residuals. Consumes their
/// columns.
Seen look_at(std::vector<Effect> effects, std::vector<EffectColumns>& columns,
             const Uncertainty& found) {
  const std::vector<ScoreRows>& scores = found.scores;
  Seen seen;
  const auto count = static_cast<Index>(effects.size());
  seen.effects = std::move(effects);
  seen.taken = MatrixXd::Zero(found.root.directions(), count);
  for (std::size_t i = 0; i < scores.size(); ++i)
    seen.taken(found.root.directions(i), Eigen::all) +=
        scores[i].all_rows().transpose() * columns[i].cast<double>();
  seen.left = MatrixXd::Zero(count, count);
  seen.score = VectorXd::Zero(count);
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const MatrixXd left =
        columns[i].cast<double>() - scores[i].all_rows() * taken_in(i, found, seen);
    seen.left.selfadjointView<Eigen::Lower>().rankUpdate(left.transpose());
    seen.score -= left.transpose() * scores[i].residual;
    columns[i] = left.cast<float>();
  }
  seen.left.triangularView<Eigen::StrictlyUpper>() = seen.left.transpose();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(seen.left);
  const VectorXd& values = solver.eigenvalues();
  Index first = 0;
  while (first < count && !(values(first) > kLeastInformation)) ++first;
  const Index determined = count - first;
  seen.basis = solver.eigenvectors().rightCols(determined) *
               values.tail(determined).cwiseSqrt().cwiseInverse().asDiagonal();
  // The sizes of the effects are estimated for white noise, so that the residual without the
  // effects is only noise.
  const VectorXd size = seen.basis.transpose() * seen.score;
  const VectorXd first_guess =
      size.array() * values.tail(determined).array() / (1.0 + values.tail(determined).array());
  seen.rows.resize(scores.size());
  for (std::size_t i = 0; i < scores.size(); ++i) {
    ScoreRows& rows = seen.rows[i];
    rows.jacobian = columns[i].cast<double>() * seen.basis;
    columns[i].resize(0, 0);
    rows.residual = scores[i].residual + rows.jacobian * first_guess;
    rows.channels = scores[i].channels;
    rows.make_narrow();
  }
  return seen;
}

/// Covariance of the scores of the columns Q, and the variance of the score of each individual
/// effect.
struct ScoreCovariance {
  MatrixXd directions;  ///< W, shape (directions)^2
  VectorXd alone;       ///< variance of the score of each effect
  VectorXd freedom;     ///< degrees of freedom of each variance
};

ScoreCovariance covariance_of(const Problem& problem, std::span<const double> z, const Seen& seen,
                              int threads) {
  const Index determined = seen.basis.cols();
  const auto count = static_cast<Index>(seen.effects.size());
  const MatrixXd none = MatrixXd::Zero(determined, determined);
  if (determined == 0) return {none, VectorXd::Zero(count), VectorXd::Ones(count)};
  MatrixXd combinations(determined + count, determined);
  combinations << MatrixXd::Identity(determined, determined), seen.left * seen.basis;
  const auto scatter =
      score_contributions(seen.rows, none, combinations, threads, OwnPart::left_out);
  const auto repeats = scores_of_repeats(problem, z, seen.rows, threads);
  ScoreCovariance result;
  result.directions = none;
  for (const ScoreContribution& each : scatter) result.directions += each.covariance;
  result.alone.resize(count);
  result.freedom.resize(count);
  VectorXd widened = VectorXd::Ones(determined);
  for (Index j = 0; j < determined + count; ++j) {
    const RobustVariance robust = robust_variance(scatter, none, combinations, j);
    const RepeatVariance between = repeat_variance(repeats, scatter, none, combinations, j);
    const bool repeated = between.freedom > 0.0 && robust.variance > 0.0 &&
                          between.variance > robust.variance && rests_on_repeats(between, robust);
    if (j < determined) {
      if (repeated) widened(j) = std::sqrt(between.variance / robust.variance);
    } else {
      result.alone(j - determined) = repeated ? between.variance : robust.variance;
      result.freedom(j - determined) =
          std::clamp(repeated ? between.freedom : robust.freedom, 1.0, metrics::kManyDegrees);
    }
  }
  result.directions = widened.asDiagonal() * result.directions * widened.asDiagonal();
  return result;
}

/// Returns the covariance that the scores of the columns Q would have if the residuals were white
/// noise of the observed size.
MatrixXd white_covariance(const Seen& seen) {
  double squares = 0.0;
  double count = 0.0;
  for (const ScoreRows& rows : seen.rows) {
    squares += rows.residual.squaredNorm();
    count += static_cast<double>(rows.residual.size());
  }
  const Index determined = seen.basis.cols();
  return squares / std::max(1.0, count) * MatrixXd::Identity(determined, determined);
}

/// Posterior of the effects' sizes, as multiples of their plausible sizes.
struct Sizes {
  VectorXd mean;
  MatrixXd covariance;
  VectorXd likeliest;  ///< joint mode; differs from the mean if an effect is truncated at zero
};

/// Minimises (x - mean)^T precision (x - mean) by coordinate descent. Some components must not be
/// negative.
VectorXd likeliest_of(const VectorXd& mean, const MatrixXd& precision,
                      const std::vector<Index>& never_negative) {
  constexpr int kMostSweeps = 1000;
  constexpr double kSettled = 1e-6;
  std::vector<bool> bounded(static_cast<std::size_t>(mean.size()), false);
  for (const Index k : never_negative) bounded[static_cast<std::size_t>(k)] = true;
  VectorXd x = mean;
  for (const Index k : never_negative) x(k) = std::max(0.0, x(k));
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double farthest = 0.0;
    for (Index k = 0; k < x.size(); ++k) {
      double next = x(k) - precision.row(k).dot(x - mean) / precision(k, k);
      if (bounded[static_cast<std::size_t>(k)]) next = std::max(0.0, next);
      farthest = std::max(farthest, std::abs(next - x(k)));
      x(k) = next;
    }
    if (farthest < kSettled) break;
  }
  return x;
}

Sizes sizes_of(const Seen& seen, const MatrixXd& directions) {
  const auto count = static_cast<Index>(seen.effects.size());
  NormalMoments sizes{VectorXd::Zero(count), MatrixXd::Identity(count, count)};
  MatrixXd precision = sizes.covariance;
  const MatrixXd felt = seen.left * seen.basis;  // T^-T
  if (felt.cols() > 0) {
    const Eigen::LDLT<MatrixXd> solver(directions);
    const MatrixXd weighted = solver.solve(felt.transpose());
    precision += felt * weighted;
    const Eigen::LLT<MatrixXd> inverse(precision);
    sizes.covariance = inverse.solve(MatrixXd::Identity(count, count));
    sizes.mean = inverse.solve(weighted.transpose() * (seen.basis.transpose() * seen.score));
  }
  std::vector<Index> never_negative;
  for (Index k = 0; k < count; ++k)
    if (seen.effects[static_cast<std::size_t>(k)].about.one_sided) never_negative.push_back(k);
  VectorXd likeliest = likeliest_of(sizes.mean, precision, never_negative);
  NormalMoments cut = cut_at_zero(std::move(sizes), never_negative);
  return {std::move(cut.mean), std::move(cut.covariance), std::move(likeliest)};
}

/// Takes the rows Q out of `seen`.
EffectLikelihood likelihood_of(Seen& seen, const ScoreCovariance& scores, const Sizes& sizes) {
  EffectLikelihood result;
  for (const Effect& each : seen.effects) {
    result.keys.push_back(each.about.key);
    result.one_sided.push_back(each.about.one_sided);
  }
  result.taken = seen.taken;
  result.felt = (seen.left * seen.basis).transpose();
  result.covariance = scores.directions;
  for (ScoreRows& each : seen.rows) result.beside.push_back(std::move(each.narrow));
  result.mean = sizes.mean;
  return result;
}

MatrixXd correlation_of(const MatrixXd& covariance) {
  const VectorXd scale = covariance.diagonal().cwiseSqrt().unaryExpr(
      [](double sd) { return sd > 0.0 ? 1.0 / sd : 0.0; });
  MatrixXd correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
  correlation.diagonal().setOnes();
  return correlation;
}

/// Returns true if a value cannot be zero, by its nature or, for a lag, by the bounds of the fit.
bool is_above_zero(const model::ParameterSpec& spec, const Unknown& unknown) {
  return spec.lower > 0.0 || (model::is_lag(spec) && unknown.lower > 0.0);
}

/// Returns true if the fit mistakes an effect of plausible size for a change of an estimate so
/// large that the model is not linear over it.
///
/// @param taken  change of the estimates, shape (all directions of the root)
bool moves_far(const Problem& problem, std::span<const double> z, const Uncertainty& found,
               const VectorXd& taken) {
  for (std::size_t j = 0; j < z.size(); ++j) {
    const auto unknown = static_cast<int>(j);
    if (!is_above_zero(problem.spec(j), problem.map.unknowns()[j])) continue;
    const double move =
        problem.map.slope(unknown, z[j]) * found.root.times(static_cast<Index>(j), taken)(0);
    if (std::abs(move) > kFarMove * problem.map.to_physical(unknown, z[j])) return true;
  }
  return false;
}

/// Returns the parameters after a move of the estimates, in the unit box. Returns std::nullopt if
/// they would leave the box.
///
/// @param move  change of the estimates, shape (all directions of the root)
std::optional<std::vector<double>> moved_by(std::span<const double> z, const Uncertainty& found,
                                            const VectorXd& move) {
  std::vector<double> there(z.begin(), z.end());
  for (std::size_t j = 0; j < there.size(); ++j) {
    there[j] += found.root.times(static_cast<Index>(j), move)(0);
    if (!(there[j] >= 0.0 && there[j] <= 1.0)) return std::nullopt;
  }
  return there;
}

/// An effect and the estimates that have followed it, in the unit box.
struct Followed {
  Index effect;
  std::vector<double> there;
};

/// Replaces the columns of effects that the estimates have followed. A column is the change in the
/// weighted outputs of one condition, less the first-order change due to the estimates.
///
/// @param taken  change of the estimates per plausible size, shape (directions of the condition,
///               effects)
void follow(const Problem& problem, std::size_t condition, std::span<const double> z,
            const std::vector<Followed>& followed, const std::vector<Effect>& effects,
            const ScoreRows& scores, const MatrixXd& taken, const std::atomic<bool>* cancel,
            EffectColumns& columns) {
  if (followed.empty()) return;
  const auto outputs = [&](std::span<const double> at, const std::vector<Effect>& with) {
    return outputs_with(problem, condition, at, with,
                        VectorXd::Ones(static_cast<Index>(with.size())), Derivatives::none, cancel)
        .outputs;
  };
  const VectorXd base = outputs(z, {});
  for (const Followed& each : followed) {
    const VectorXd with = outputs(each.there, {effects[static_cast<std::size_t>(each.effect)]});
    if (base.size() == 0 || with.size() == 0) continue;
    const VectorXd change = with - base + scores.all_rows() * taken.col(each.effect);
    if (change.allFinite()) columns.col(each.effect) = change.cast<float>();
  }
}

/// Recomputes the secants of curved effects at the sizes that follow from prior and records. An
/// effect that would move an estimate far is simulated once more at its plausible size, at the
/// estimates that have followed it: what it leaves in the residuals is not linear over such a move.
///
/// @return  true if any secant was recomputed. In that case `columns` contains the columns of all
///          effects, and `seen` no longer has its rows, because keeping both would take half of a
///          fit's memory.
bool take_again(const Problem& problem, std::span<const double> z, const Uncertainty& found,
                const Sizes& sizes, int threads, const std::atomic<bool>* cancel, Seen& seen,
                std::vector<EffectColumns>& columns) {
  std::vector<Effect> again;
  std::vector<Index> which;
  std::vector<Followed> followed;
  for (std::size_t e = 0; e < seen.effects.size(); ++e) {
    const auto k = static_cast<Index>(e);
    Effect& effect = seen.effects[e];
    if (effect.curved) {
      const double size =
          std::max(kLeastSecant, std::sqrt(sizes.mean(k) * sizes.mean(k) + sizes.covariance(k, k)));
      if (std::abs(std::log(size / effect.secant)) < kSameSize) continue;
      effect.secant = size;
      again.push_back(effect);
      which.push_back(k);
    } else if (!effect.followed && !effect.is_of_sensor() &&
               moves_far(problem, z, found, seen.taken.col(k))) {
      auto there = moved_by(z, found, -seen.taken.col(k));
      if (!there) continue;
      effect.followed = true;
      followed.push_back({k, std::move(*there)});
    }
  }
  if (again.empty() && followed.empty()) return false;
  const MatrixXd felt = seen.left * seen.basis;
  parallel_for(columns.size(), threads, [&](std::size_t i) {
    const MatrixXd taken = taken_in(i, found, seen);
    columns[i] =
        MatrixXd(seen.rows[i].all_rows() * felt.transpose() + found.scores[i].all_rows() * taken)
            .cast<float>();
    seen.rows[i].narrow.resize(0, 0);
    const MatrixXd anew = effect_rows(problem, i, z, again, cancel);
    for (std::size_t a = 0; a < which.size(); ++a) {
      const auto column = static_cast<Index>(a);
      if (anew.col(column).allFinite()) columns[i].col(which[a]) = anew.col(column).cast<float>();
    }
    follow(problem, i, z, followed, seen.effects, found.scores[i], taken, cancel, columns[i]);
  });
  return true;
}

/// Computes the sizes of the effects and the move of the estimates if the effects exceed the range
/// in which the linear model is accurate. Instead of using secants, it simulates all effects
/// together at the moved parameters; the sensitivities remain those of the fit (chord iterations).
/// The scores and residuals are then replaced by those that a model linear about the optimum would
/// give.
///
/// @param moved  move of the estimates, shape (all directions of the root)
/// @return  true if the iterations converged; if not, nothing has been changed
bool follow_curvature(const Problem& problem, std::span<const double> z, const Uncertainty& found,
                      const MatrixXd& directions, int threads, const std::atomic<bool>* cancel,
                      Seen& seen, Sizes& sizes, VectorXd& moved) {
  Seen next{seen.effects, seen.taken, seen.left, seen.score, seen.basis, {}};
  std::vector<VectorXd> residuals(problem.conditions.size());
  Sizes at = sizes;
  VectorXd move = moved;
  const MatrixXd felt = seen.left * seen.basis;
  std::vector<VectorXd> base(problem.conditions.size());
  const VectorXd none = VectorXd::Zero(at.mean.size());
  parallel_for(base.size(), threads, [&](std::size_t i) {
    base[i] = outputs_with(problem, i, z, seen.effects, none, Derivatives::none, cancel).outputs;
  });
  for (int chord = 0; chord < kMostChords; ++chord) {
    const auto there = moved_by(z, found, move);
    if (!there) return false;
    std::vector<VectorXd> scores(base.size());
    std::vector<VectorXd> taken(base.size());
    std::atomic<bool> failed = false;
    parallel_for(base.size(), threads, [&](std::size_t i) {
      const VectorXd outputs =
          outputs_with(problem, i, *there, seen.effects, at.mean, Derivatives::none, cancel)
              .outputs;
      if (outputs.size() == 0 || base[i].size() == 0) {
        failed = true;
        return;
      }
      const ScoreRows& rows = found.scores[i];
      residuals[i] = rows.residual + outputs - base[i];
      const MatrixXd left = seen.rows[i].all_rows();
      const MatrixXd jacobian = rows.all_rows();
      const VectorXd linear =
          left * (felt.transpose() * at.mean) +
          jacobian * (taken_in(i, found, seen) * at.mean + move(found.root.directions(i))) -
          residuals[i];
      scores[i] = left.transpose() * linear;
      taken[i] = jacobian.transpose() * linear;
    });
    if (failed) return false;
    VectorXd score = VectorXd::Zero(felt.cols());
    VectorXd free_move = VectorXd::Zero(move.size());
    for (std::size_t i = 0; i < base.size(); ++i) {
      score += scores[i];
      free_move(found.root.directions(i)) += taken[i];
    }
    next.score = felt * score;
    at = sizes_of(next, directions);
    const VectorXd last = move;
    move = free_move - seen.taken * at.mean;
    if ((move - last).norm() > kSettledMove) continue;
    seen.score = std::move(next.score);
    for (std::size_t i = 0; i < residuals.size(); ++i)
      seen.rows[i].residual = std::move(residuals[i]);
    sizes = std::move(at);
    moved = move;
    return true;
  }
  return false;
}

/// Tests whether the residuals indicate each effect, one at a time.
void test_alone(const Seen& seen, const ScoreCovariance& scores,
                std::vector<ConsideredEffect>& about) {
  std::vector<double> p_values;
  std::vector<std::size_t> tested;
  for (std::size_t e = 0; e < about.size(); ++e) {
    const auto k = static_cast<Index>(e);
    const double left = seen.left(k, k);
    if (!(left > kLeastInformation) || !(scores.alone(k) > 0.0)) continue;
    ConsideredEffect& effect = about[e];
    const double error = std::sqrt(scores.alone(k));
    const double t = seen.score(k) / error;
    const double above = 1.0 - metrics::student_t_cdf(t, scores.freedom(k));
    effect.p_value = effect.one_sided ? above : 2.0 * std::min(above, 1.0 - above);
    effect.alone = effect.size * seen.score(k) / left;
    effect.alone_error = effect.size * error / left;
    effect.alone_half_width = student_t(scores.freedom(k)) * *effect.alone_error;
    if (!effect.one_sided || t > 0.0) effect.explains = seen.score(k) * seen.score(k) / left;
    tested.push_back(e);
    p_values.push_back(*effect.p_value);
  }
  const auto together = metrics::holm(p_values);
  for (std::size_t i = 0; i < tested.size(); ++i) about[tested[i]].p_of_all = together[i];
}

/// Returns the effect that explains most of what remains after the selected effects, if it is
/// significant in addition to them.
std::optional<std::size_t> next_missing(const Seen& seen, const ScoreCovariance& scores,
                                        const std::vector<ConsideredEffect>& about,
                                        const std::vector<std::size_t>& taken) {
  const MatrixXd felt = seen.left * seen.basis;
  const MatrixXd variance = felt * scores.directions * felt.transpose();
  const std::vector<Index> columns(taken.begin(), taken.end());
  std::vector<double> p_values;
  std::vector<std::size_t> tested;
  std::vector<double> gains;
  const MatrixXd among = seen.left(columns, columns);
  const Eigen::LDLT<MatrixXd> solver(among);
  for (std::size_t e = 0; e < about.size(); ++e) {
    const auto k = static_cast<Index>(e);
    if (std::find(taken.begin(), taken.end(), e) != taken.end() || !about[e].p_value) continue;
    // An effect that would be negative on its own cannot be the explanation, whatever its sign in
    // combination with others.
    if (about[e].one_sided && seen.score(k) < 0.0) continue;
    // Score, information and score variance of this effect, given the selected ones.
    VectorXd weights = VectorXd::Zero(seen.left.rows());
    weights(k) = 1.0;
    if (!columns.empty()) {
      const VectorXd along = seen.left(columns, k);
      const VectorXd beside = solver.solve(along);
      for (std::size_t c = 0; c < columns.size(); ++c)
        weights(columns[c]) = -beside(static_cast<Index>(c));
    }
    const double information = weights.dot(seen.left * weights);
    const double spread = weights.dot(variance * weights);
    if (!(information > 0.01 * seen.left(k, k)) || !(spread > 0.0)) continue;
    // The variance of the effect's own score may come from the repeats, which are more informative
    // than `variance`.
    const double widened = std::max(1.0, scores.alone(k) / variance(k, k));
    const double score = weights.dot(seen.score);
    const double t = score / std::sqrt(spread * widened);
    const double above = 1.0 - metrics::student_t_cdf(t, scores.freedom(k));
    tested.push_back(e);
    p_values.push_back(about[e].one_sided ? above : 2.0 * std::min(above, 1.0 - above));
    gains.push_back(about[e].one_sided && score < 0.0 ? 0.0 : score * score / information);
  }
  if (tested.empty()) return std::nullopt;
  const auto together = metrics::holm(p_values);
  const auto best = std::max_element(gains.begin(), gains.end()) - gains.begin();
  if (together[static_cast<std::size_t>(best)] >= kMissingLevel) return std::nullopt;
  return tested[static_cast<std::size_t>(best)];
}

/// Selects missing effects by forward selection, as long as a further effect is significant in
/// addition to those selected.
std::vector<std::size_t> missing_effects(const Seen& seen, const ScoreCovariance& scores,
                                         const std::vector<ConsideredEffect>& about) {
  std::vector<std::size_t> taken;
  while (taken.size() < std::min(kMostMissing, about.size())) {
    const auto next = next_missing(seen, scores, about, taken);
    if (!next) break;
    taken.push_back(*next);
  }
  return taken;
}

/// Returns the variance of a score relative to its variance for white noise of variance 1.
double score_inflation(const Seen& seen, const ScoreCovariance& scores, std::size_t effect) {
  const auto k = static_cast<Index>(effect);
  return std::max(scores.alone(k) / seen.left(k, k), 1e-300);
}

/// A refitted model.
struct RefittedFit {
  std::vector<std::size_t> effects;
  Refit refit;

  /// Returns minus twice the log posterior, up to a constant. If two effects act alike, this
  /// favours the one that needs the more plausible size.
  double misfit(double scale) const { return refit.squares / scale + refit.sizes.squaredNorm(); }
};

/// Refits the effects that explain most, first individually and then in combination. Score tests
/// are linear about the fit, which has mistaken the missing effect for a change in the estimates,
/// so they may confuse two effects that act alike. The effect with the highest posterior is named
/// first.
std::vector<RefittedFit> refit_best(const Problem& problem, std::span<const double> z,
                                    const Uncertainty& found, const Seen& seen,
                                    const ScoreCovariance& scores, int threads,
                                    const std::atomic<bool>* cancel,
                                    const std::vector<ConsideredEffect>& about,
                                    std::vector<std::size_t>& missing) {
  std::vector<RefittedFit> models;
  if (missing.empty() || z.size() > kMostRefitted) return models;
  const Refitter refitter(problem, z, found.scores, threads, cancel);
  // Each refit starts where the linear model with these effects predicts the minimum.
  const auto refit = [&](const std::vector<std::size_t>& which, const std::vector<double>& from,
                         const VectorXd& sizes) {
    std::vector<Effect> effects;
    for (const std::size_t e : which) effects.push_back(seen.effects[e]);
    return refitter.fit(effects, from, sizes);
  };
  auto plain = refit({}, {z.begin(), z.end()}, VectorXd::Zero(0));
  if (!plain) return models;
  const double scale = score_inflation(seen, scores, missing.front());
  // The effects are tested individually rather than all together: it has already been decided that
  // some effect is present, and the test of the right effect may be weak if the linear model is far
  // off. An effect that would need an implausible size is excluded, such as hoses instead of oil
  // compressibility.
  const auto plausible = [&](std::size_t e) {
    const double size = about[e].alone.value_or(0.0) / about[e].size / kMistakenSize;
    return size * size < about[missing.front()].explains / scale;
  };
  std::vector<std::size_t> candidates;
  for (std::size_t e = 0; e < about.size(); ++e) {
    if (e == missing.front() || (about[e].p_value.value_or(1.0) < kMissingLevel && plausible(e)))
      candidates.push_back(e);
  }
  const auto explains_more = [&](std::size_t a, std::size_t b) {
    return about[a].explains > about[b].explains;
  };
  std::stable_sort(candidates.begin(), candidates.end(), explains_more);
  const double enough = kWorthRefitting * about[candidates.front()].explains;
  for (std::size_t c = 0; c < std::min(kMostCandidates, candidates.size()); ++c) {
    const std::size_t e = candidates[c];
    if (about[e].explains < enough) break;
    const auto k = static_cast<Index>(e);
    const double size = about[e].alone.value_or(0.0) / about[e].size;
    std::vector<double> from(z.begin(), z.end());
    const VectorXd move = -size * seen.taken.col(k);
    for (std::size_t j = 0; j < from.size(); ++j) {
      from[j] = std::clamp(from[j] + found.root.times(static_cast<Index>(j), move)(0), 0.0, 1.0);
    }
    auto each = refit({e}, from, VectorXd::Constant(1, size));
    if (!each) each = refit({e}, {z.begin(), z.end()}, VectorXd::Constant(1, 0.3 * size));
    if (each && each->sizes(0) != 0.0) models.push_back({{e}, std::move(*each)});
  }
  if (models.empty()) return models;
  const auto leaves_less = [&](const RefittedFit& a, const RefittedFit& b) {
    return a.misfit(scale) < b.misfit(scale);
  };
  RefittedFit best = *std::min_element(models.begin(), models.end(), leaves_less);
  while (best.effects.size() < kMostMissing) {
    const auto next = next_missing(seen, scores, about, best.effects);
    if (!next) break;
    std::vector<std::size_t> which = best.effects;
    which.push_back(*next);
    VectorXd sizes(best.refit.sizes.size() + 1);
    sizes << best.refit.sizes, kFirstSize;
    auto more = refit(which, best.refit.z, sizes);
    if (!more || more->sizes(more->sizes.size() - 1) == 0.0) break;
    // The score test may mistake the curvature of the first effect for an additional effect.
    const auto k = static_cast<Index>(*next);
    const double t = std::sqrt(std::max(0.0, best.refit.squares - more->squares) /
                               score_inflation(seen, scores, *next));
    const double p =
        (about[*next].one_sided ? 1.0 : 2.0) * (1.0 - metrics::student_t_cdf(t, scores.freedom(k)));
    if (p * static_cast<double>(about.size()) >= kMissingLevel) break;
    best = {std::move(which), std::move(*more)};
    models.push_back(best);
  }
  missing = best.effects;
  models.push_back({{}, std::move(*plain)});
  return models;
}

/// Stores the refits in the result: sizes and errors of the missing effects, and the models with
/// their weights.
void describe_refits(const Seen& seen, const ScoreCovariance& scores,
                     const std::vector<RefittedFit>& models,
                     const std::vector<std::size_t>& missing, Considered& considered) {
  if (models.empty()) return;
  const RefittedFit& plain = models.back();
  const double scale = score_inflation(seen, scores, missing.front());
  double least = HUGE_VAL;
  for (const RefittedFit& each : models) {
    RefittedModel& model = considered.refitted.emplace_back();
    for (std::size_t i = 0; i < each.effects.size(); ++i) {
      ConsideredEffect& about = considered.effects[each.effects[i]];
      const auto k = static_cast<Index>(i);
      model.effects.push_back(about.key);
      model.sizes.push_back(about.size * each.refit.sizes(k));
      const bool is_best = each.effects == missing;
      if (each.effects.size() > 1 && !is_best) continue;
      const Index row = static_cast<Index>(each.refit.z.size()) + k;
      const double spread = std::sqrt(score_inflation(seen, scores, each.effects[i]) *
                                      each.refit.covariance(row, row));
      about.alone = model.sizes.back();
      about.alone_error = about.size * spread;
      about.alone_half_width =
          student_t(scores.freedom(static_cast<Index>(each.effects[i]))) * *about.alone_error;
    }
    model.fall = plain.refit.squares - each.refit.squares;
    if (each.refit.held_out && plain.refit.held_out)
      model.held_out_fall = *plain.refit.held_out - *each.refit.held_out;
    model.weight = each.misfit(scale) + 2.0 * static_cast<double>(each.effects.size());
    least = std::min(least, model.weight);
  }
  double sum = 0.0;
  for (RefittedModel& each : considered.refitted) {
    each.weight = std::exp(-0.5 * (each.weight - least));
    sum += each.weight;
  }
  for (RefittedModel& each : considered.refitted) each.weight /= sum;
}

/// Returns the average of an estimate over the refitted models.
std::optional<AveragedEstimate> averaged_over(const Problem& problem, std::size_t unknown,
                                              const std::vector<RefittedFit>& models,
                                              const Considered& considered, double scale) {
  if (models.empty()) return std::nullopt;
  const auto j = static_cast<int>(unknown);
  AveragedEstimate result;
  std::vector<double> values;
  for (std::size_t m = 0; m < models.size(); ++m) {
    values.push_back(problem.map.to_physical(j, models[m].refit.z[unknown]));
    result.value += considered.refitted[m].weight * values.back();
  }
  double variance = 0.0;
  for (std::size_t m = 0; m < models.size(); ++m) {
    const Refit& refit = models[m].refit;
    const double slope = problem.map.slope(j, refit.z[unknown]);
    const double within = scale * slope * slope * refit.covariance(j, j);
    const double off = values[m] - result.value;
    variance += considered.refitted[m].weight * (within + off * off);
  }
  result.standard_error = std::sqrt(variance);
  return result;
}

/// Returns the uncertainty budget of one estimate, based on the error that it would have if the
/// model were exact. If an effect was refitted, the averaged estimate provides a correction that
/// does not rely on a linear model. Its difference from the linear correction is a contribution
/// with a uniform distribution.
///
/// @param moves  change in the estimate due to each effect at its plausible size, SI
/// @param shift  change in the estimate due to the mean sizes of the effects, SI
Budget95 budget_of(const Uncertainty& found, std::size_t unknown, const FittedParameter& parameter,
                   double slope, const Seen& seen, const VectorXd& moves, const Sizes& sizes,
                   double shift) {
  Budget95 budget;
  const bool robust = parameter.ci95_from == IntervalSource::robust_standard_error;
  const double exact =
      (robust ? parameter.robust_standard_error : parameter.standard_error).value_or(0.0);
  double known = 0.0;
  std::vector<BudgetLine> stated;
  for (std::size_t p = 0; p < found.known.names.size(); ++p) {
    const double part =
        std::abs(slope * found.known.response(static_cast<Index>(unknown), static_cast<Index>(p)));
    known += part * part;
    stated.push_back({found.known.names[p], "known_value", part});
  }
  const double noise = std::sqrt(std::max(0.0, exact * exact - known));
  budget.lines.push_back(
      {robust && found.from_repeats[unknown] ? "repeats" : "noise", "records", noise});
  budget.lines.insert(budget.lines.end(), stated.begin(), stated.end());
  const VectorXd parts = variances_by_effect(moves, sizes.covariance);
  for (Index k = 0; k < parts.size(); ++k) {
    const ConsideredEffect& about = seen.effects[static_cast<std::size_t>(k)].about;
    budget.lines.push_back({about.key, "effect", std::sqrt(parts(k)), moves(k) / about.size});
  }
  double rest = known + parts.sum();
  if (parameter.averaged) {
    const double differ = parameter.averaged->value - (parameter.value + shift);
    const double evenly = std::abs(differ) / std::numbers::sqrt3;
    budget.lines.push_back({"nonlinearity", "effect", evenly, 0.0});
    rest += evenly * evenly;
  }
  budget.combined = std::sqrt(noise * noise + rest);
  const std::vector<metrics::ErrorPart> variances{
      {noise * noise, parameter.degrees_of_freedom.value_or(metrics::kManyDegrees)}, {rest}};
  budget.degrees_of_freedom = metrics::effective_freedom(variances);
  budget.coverage_factor = student_t(budget.degrees_of_freedom);
  budget.expanded = budget.coverage_factor * budget.combined;
  budget.shift = shift;
  return budget;
}

/// Returns the contributions to an estimate that its interval leaves out.
///
/// @param by_simulation  upper limit for the error due to the simulations, SI
std::vector<BudgetLine> beside_budget(const FittedParameter& parameter, double by_simulation) {
  std::vector<BudgetLine> lines{{"numerics", "numerics", by_simulation}};
  if (parameter.between_days_error)
    lines.push_back({"days", "days", *parameter.between_days_error});
  return lines;
}

/// Upper limits on how far model error that no effect explains could move each estimate, in the
/// unit box. In each signal the error is assumed to be in phase with the sensitivity at every
/// sample; the moves by different signals add up as squares.
struct UnexplainedMoves {
  VectorXd shown;   ///< by an error as large as the residual without the effects, if significant
  VectorXd unseen;  ///< by the largest error that adequacy tolerates and that no test would show
};

/// @param rows  rows whose residuals exclude the effects
UnexplainedMoves unexplained_moves(const Problem& problem, const std::vector<ScoreRows>& scores,
                                   const std::vector<ScoreRows>& rows, const ArrowRoot& root) {
  std::vector<LackOfFit> tests;
  // How far an error as large as the noise could move each unknown that acts in the condition.
  std::vector<VectorXd> moves;
  std::vector<const std::vector<int>*> whose;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ProblemCondition& condition = problem.conditions[i];
    const std::vector<int>& acting = problem.map.acting(i);
    const MatrixXd by_direction = root.rows(acting, i).transpose();
    const Index samples = rows[i].residual.size() / rows[i].channels;
    for (Index k = 0; k < rows[i].channels; ++k) {
      const ProblemChannel& channel = condition.channels[static_cast<std::size_t>(k)];
      const VectorXd left = rows[i].residual.segment(k * samples, samples) * channel.sd;
      const auto test = lack_of_prediction(
          condition, channel, std::span(left.data(), static_cast<std::size_t>(left.size())));
      if (!test) continue;
      tests.push_back(*test);
      whose.push_back(&acting);
      const MatrixXd felt = scores[i].rows(k * samples, samples) * by_direction;
      moves.push_back(std::sqrt(static_cast<double>(samples)) * felt.colwise().norm().transpose());
    }
  }
  const auto count = static_cast<double>(tests.size());
  const double tolerated = problem.campaign->acceptance_bounds.model_error_to_noise;
  VectorXd shown = VectorXd::Zero(root.unknowns());
  VectorXd unseen = VectorXd::Zero(root.unknowns());
  for (std::size_t t = 0; t < tests.size(); ++t) {
    const VectorXd squares = moves[t].cwiseAbs2();
    if (tests[t].p * count < kUnexplainedLevel)
      shown(*whose[t]) += std::max(0.0, tests[t].ratio - 1.0) * squares;
    const double hidden = detectable_error(tests[t], metrics::kWarningLevel / count);
    unseen(*whose[t]) += std::pow(std::min(tolerated, hidden), 2) * squares;
  }
  return {shown.cwiseSqrt(), unseen.cwiseSqrt()};
}

/// Returns the upper end of the interval of a value that cannot be zero, if its logarithm is linear
/// in the effects. Such a value is known up to a factor.
///
/// @param shift  largest shift of the value that the effects cause to first order, SI
double end_in_proportion(const FittedParameter& parameter, const Budget95& budget, double shift) {
  const double shifted = parameter.value * std::exp(shift / parameter.value);
  const double refitted = parameter.averaged ? parameter.averaged->value : 0.0;
  return std::max(shifted, refitted) * std::exp(budget.expanded / parameter.value);
}

/// Widens the interval of an estimate. It is not known which effects are present, so the interval
/// covers the estimate, the estimate shifted by the mean sizes of the effects, the estimate shifted
/// by their likeliest sizes, and, if the residuals indicate an effect, the averaged estimate, each
/// plus or minus the expanded uncertainty. This applies to the averaged estimate, too, because the
/// refitted models contain a few effects and lack all others.
///
/// If the interval extends beyond a fifth of the value, it matters whether the value or its
/// logarithm is linear in the effects. The interval then covers both cases.
///
/// @param likeliest  shift due to the likeliest sizes, SI
void widen(const Problem& problem, std::size_t unknown, Budget95 budget, double likeliest,
           FittedParameter& parameter) {
  const model::ParameterSpec& spec = problem.spec(unknown);
  auto& [low, high] = *parameter.ci95;
  const double shift = std::max({0.0, budget.shift, likeliest});
  low = std::min(low, parameter.value + std::min({0.0, budget.shift, likeliest}) - budget.expanded);
  high = std::max(high, parameter.value + shift + budget.expanded);
  if (parameter.averaged) {
    const AveragedEstimate& averaged = *parameter.averaged;
    const double half = std::max(budget.expanded, budget.coverage_factor * averaged.standard_error);
    low = std::min(low, averaged.value - half);
    high = std::max(high, averaged.value + half);
  }
  if (is_above_zero(spec, problem.map.unknowns()[unknown]) && budget.contribution("effect") > 0.0 &&
      high - parameter.value > kWeak * parameter.value) {
    // The factor overflows for a huge uncertainty. If the parameter has no upper limit either, the
    // linear end stays, because a result needs a finite number.
    const double end = std::min(spec.upper, end_in_proportion(parameter, budget, shift));
    if (std::isfinite(end)) high = std::max(high, end);
  }
  low = std::max(spec.lower, low);
  high = std::min(spec.upper, high);
  parameter.budget = std::move(budget);
}

}  // namespace

void consider_effects(const Problem& problem, std::span<const double> z, const Uncertainty& found,
                      int threads, const std::atomic<bool>* cancel, Fit& fit,
                      std::optional<EffectLikelihood>* likelihood) {
  if (found.scores.empty() || found.root.directions() == 0) return;
  Considered considered;
  considered.left_out = left_out_effects(problem, z);
  std::vector<Effect> effects = effects_of(problem, z);
  std::vector<EffectColumns> columns(problem.conditions.size());
  parallel_for(columns.size(), threads, [&](std::size_t i) {
    columns[i] = effect_rows(problem, i, z, effects, cancel).cast<float>();
  });
  if (cancel != nullptr && cancel->load()) return;
  std::vector<ConsideredEffect> dropped;
  drop_failed(effects, columns, dropped);
  std::optional<Seen> seen;
  Sizes sizes;
  VectorXd moved;
  std::vector<RefittedFit> models;
  std::vector<std::size_t> missing;  // indices of the missing effects
  double scale = 1.0;
  if (!effects.empty()) {
    seen = look_at(std::move(effects), columns, found);
    // The assumption of white noise is accurate enough for choosing the size of a secant.
    sizes = sizes_of(*seen, white_covariance(*seen));
    for (int i = 0; i < kMostSecants; ++i) {
      if (!take_again(problem, z, found, sizes, threads, cancel, *seen, columns)) break;
      if (cancel != nullptr && cancel->load()) return;
      seen = look_at(std::move(seen->effects), columns, found);
      sizes = sizes_of(*seen, white_covariance(*seen));
    }
    const ScoreCovariance scores = covariance_of(problem, z, *seen, threads);
    sizes = sizes_of(*seen, scores.directions);
    moved = -seen->taken * sizes.mean;
    for (const Effect& each : seen->effects) considered.effects.push_back(each.about);
    test_alone(*seen, scores, considered.effects);
    missing = missing_effects(*seen, scores, considered.effects);
    if (!missing.empty() && follow_curvature(problem, z, found, scores.directions, threads, cancel,
                                             *seen, sizes, moved)) {
      for (std::size_t e = 0; e < considered.effects.size(); ++e)
        considered.effects[e] = seen->effects[e].about;
      test_alone(*seen, scores, considered.effects);
      missing = missing_effects(*seen, scores, considered.effects);
    }
    if (likelihood != nullptr) *likelihood = likelihood_of(*seen, scores, sizes);
    // From here on only the residuals are needed, and a refit needs the memory.
    for (ScoreRows& each : seen->rows) each.narrow.resize(0, 0);
    models =
        refit_best(problem, z, found, *seen, scores, threads, cancel, considered.effects, missing);
    if (cancel != nullptr && cancel->load()) return;
    describe_refits(*seen, scores, models, missing, considered);
    if (!models.empty()) scale = score_inflation(*seen, scores, missing.front());
    considered.correlation = correlation_of(sizes.covariance);
    for (std::size_t e = 0; e < considered.effects.size(); ++e) {
      const auto k = static_cast<Index>(e);
      ConsideredEffect& about = considered.effects[e];
      about.estimate = about.size * sizes.mean(k);
      about.standard_error = about.size * std::sqrt(std::max(0.0, sizes.covariance(k, k)));
    }
  } else {
    moved = VectorXd::Zero(found.root.directions());
    seen.emplace();
    seen->taken = MatrixXd::Zero(found.root.directions(), 0);
    sizes.mean = VectorXd::Zero(0);
    sizes.covariance = MatrixXd::Zero(0, 0);
    sizes.likeliest = VectorXd::Zero(0);
  }
  const double simulation_error = largest_simulation_error(problem);
  const UnexplainedMoves unexplained = unexplained_moves(
      problem, found.scores, seen->rows.empty() ? found.scores : seen->rows, found.root);
  for (std::size_t j = 0; j < z.size(); ++j) {
    FittedParameter& parameter = fit.parameters[j];
    if (!parameter.ci95) continue;
    const double slope = problem.map.slope(static_cast<int>(j), z[j]);
    const VectorXd moves = slope * found.root.times(static_cast<Index>(j), seen->taken);
    const double shift = slope * found.root.times(static_cast<Index>(j), moved)(0);
    const double likeliest = shift - moves.dot(sizes.likeliest - sizes.mean);
    parameter.averaged = averaged_over(problem, j, models, considered, scale);
    Budget95 budget = budget_of(found, j, parameter, slope, *seen, moves, sizes, shift);
    const auto row = static_cast<Index>(j);
    const double white = std::abs(slope) * std::sqrt(found.root.product(row, row));
    budget.beside = beside_budget(parameter, simulation_error * white);
    widen(problem, j, std::move(budget), likeliest, parameter);
    const std::string exact = fmt::format("{}: {}", problem.name(j), parameter.reason);
    grade_widened(problem, found, j, parameter);
    // The warning about an estimate must describe its new interval.
    const std::string widened = fmt::format("{}: {}", problem.name(j), parameter.reason);
    const auto warning = std::find(fit.warnings.begin(), fit.warnings.end(), exact);
    if (warning != fit.warnings.end())
      *warning = widened;
    else if (parameter.identifiability != Identifiability::identified)
      fit.warnings.push_back(widened);
    parameter.moved_by_unexplained = std::abs(slope) * unexplained.shown(row);
    parameter.moved_by_unseen = std::abs(slope) * unexplained.unseen(row);
    if (!models.empty()) {
      const auto best = std::find_if(models.begin(), models.end(), [&](const RefittedFit& each) {
        return each.effects == missing;
      });
      parameter.moved_by_missing = std::abs(
          problem.map.to_physical(static_cast<int>(j), best->refit.z[j]) - parameter.value);
      continue;
    }
    for (const std::size_t e : missing) {
      const double by_it = moves(static_cast<Index>(e)) / considered.effects[e].size *
                           considered.effects[e].alone.value_or(0.0);
      parameter.moved_by_missing = std::max(parameter.moved_by_missing, std::abs(by_it));
    }
  }
  for (const std::size_t e : missing) considered.missing.push_back(considered.effects[e].key);
  considered.effects.insert(considered.effects.end(), dropped.begin(), dropped.end());
  fit.considered = std::move(considered);
}

}  // namespace rigcal::calib
