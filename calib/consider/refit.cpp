#include "calib/consider/refit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "calib/problem/evaluation.hpp"
#include "common/parallel.hpp"

namespace rigcal::calib {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostRefitSteps = 12;
constexpr int kMostStepHalvings = 5;
/// The search ends when the predicted decrease in the sum of squares is below this, in variances of
/// a weighted residual.
constexpr double kSettledFall = 0.02;
/// A step is accepted only if the actual decrease is at least this fraction of the predicted one.
/// Close to a kink the derivatives predict decreases that no step achieves, and tiny decreases
/// would continue until the last iteration.
constexpr double kLeastFall = 0.01;
/// Smallest decrease that the simulations resolve, in variances of a weighted residual.
constexpr double kResolvedFall = 1.0;
/// Minimum size as a multiple of the plausible size. A smaller one, such as a very short and
/// therefore stiff lag, counts as zero.
constexpr double kLeastSize = 0.02;
/// This is added to the scaled J^T J, so that there is no step in undetermined directions.
constexpr double kRidge = 1e-9;

/// Returns (J^T J)^-1, computed with columns scaled to length 1.
MatrixXd scaled_inverse(const MatrixXd& normal) {
  const VectorXd scale =
      normal.diagonal().cwiseSqrt().unaryExpr([](double d) { return d > 0.0 ? 1.0 / d : 1.0; });
  MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  scaled.diagonal().array() += kRidge;
  const MatrixXd inverse =
      Eigen::LLT<MatrixXd>(scaled).solve(MatrixXd::Identity(normal.rows(), normal.cols()));
  return scale.asDiagonal() * inverse * scale.asDiagonal();
}

/// Sets a one-sided size to zero if it is negative or too small to simulate.
VectorXd within_signs(const std::vector<Effect>& effects, VectorXd sizes) {
  for (std::size_t e = 0; e < effects.size(); ++e) {
    double& size = sizes(static_cast<Index>(e));
    if (effects[e].about.one_sided && size < kLeastSize) size = 0.0;
  }
  return sizes;
}

}  // namespace

Refitter::Refitter(const Problem& problem, std::span<const double> z,
                   const std::vector<ScoreRows>& scores, int threads,
                   const std::atomic<bool>* cancel)
    : problem_(problem),
      scores_(scores),
      threads_(threads),
      cancel_(cancel),
      base_(problem.conditions.size()) {
  parallel_for(base_.size(), threads, [&](std::size_t i) {
    base_[i] = outputs_with(problem, i, z, {}, VectorXd::Zero(0), Derivatives::of_unknowns, cancel)
                   .outputs;
  });
}

Refitter::Part Refitter::squares_at(std::size_t condition, const std::vector<Effect>& effects,
                                    std::span<const double> z, const VectorXd& sizes) const {
  Part part;
  const OutputsWith with =
      outputs_with(problem_, condition, z, effects, sizes, Derivatives::of_unknowns, cancel_);
  if (!with.ok() || base_[condition].size() == 0) return part;
  part.residual = scores_[condition].residual + with.outputs - base_[condition];
  const VectorXd slopes = acting_slopes(problem_, condition, z);
  part.jacobian.resize(part.residual.size(), slopes.size() + sizes.size());
  part.jacobian.leftCols(slopes.size()) = with.jacobian * slopes.asDiagonal();
  for (Index e = 0; e < sizes.size(); ++e) {
    if (effects[static_cast<std::size_t>(e)].is_of_sensor())
      part.jacobian.col(slopes.size() + e) = with.by_sensor.col(e);
  }
  part.squares = part.residual.squaredNorm();
  part.ok = std::isfinite(part.squares);
  return part;
}

void Refitter::complete(std::size_t condition, const std::vector<Effect>& effects,
                        std::span<const double> z, const VectorXd& sizes, Part& part) const {
  const std::vector<int>& acting = problem_.map.acting(condition);
  const Index unknowns = part.jacobian.cols() - sizes.size();
  // Both runs of a difference are made without derivatives, because derivatives change the error
  // control.
  const auto plain = [&](const VectorXd& at) {
    return outputs_with(problem_, condition, z, effects, at, Derivatives::none, cancel_);
  };
  std::optional<OutputsWith> here;
  for (Index e = 0; e < sizes.size(); ++e) {
    if (effects[static_cast<std::size_t>(e)].is_of_sensor()) continue;
    if (!here) here = plain(sizes);
    VectorXd further = sizes;
    further(e) += kEffectStep;
    const OutputsWith there = plain(further);
    part.ok = here->ok() && there.ok();
    if (!part.ok) return;
    part.jacobian.col(unknowns + e) = (there.outputs - here->outputs) / kEffectStep;
  }
  std::vector<Index> columns(acting.begin(), acting.end());
  const auto all = static_cast<Index>(z.size());
  for (Index e = 0; e < sizes.size(); ++e) columns.push_back(all + e);
  part.gradient = VectorXd::Zero(all + sizes.size());
  part.normal = MatrixXd::Zero(all + sizes.size(), all + sizes.size());
  part.gradient(columns) = part.jacobian.transpose() * part.residual;
  part.normal(columns, columns) = part.jacobian.transpose() * part.jacobian;
  part.ok = part.normal.allFinite() && part.gradient.allFinite();
  part.residual.resize(0);
  part.jacobian.resize(0, 0);
}

Refitter::Part Refitter::priors_at(std::span<const double> z, Index unknowns) const {
  Part part;
  part.ok = true;
  part.gradient = VectorXd::Zero(unknowns);
  part.normal = MatrixXd::Zero(unknowns, unknowns);
  for (std::size_t j = 0; j < z.size(); ++j) {
    const auto k = static_cast<Index>(j);
    const double residual = problem_.map.prior_residual(static_cast<int>(j), z[j]);
    const double slope = problem_.map.prior_slope(static_cast<int>(j), z[j]);
    part.squares += residual * residual;
    part.gradient(k) += slope * residual;
    part.normal(k, k) += slope * slope;
  }
  return part;
}

std::optional<Refit> Refitter::fit(const std::vector<Effect>& effects, std::vector<double> start,
                                   VectorXd sizes) const {
  const auto unknowns = static_cast<Index>(start.size());
  const Index all = unknowns + sizes.size();
  const std::size_t conditions = base_.size();
  Refit best;
  best.z = std::move(start);
  best.sizes = within_signs(effects, std::move(sizes));
  std::vector<Part> parts;
  Part sum;
  // The derivatives with respect to the effects are simulated only if the point is accepted.
  const auto evaluate = [&](std::span<const double> z, const VectorXd& at, double below,
                            std::vector<Part>& own) {
    own.assign(conditions, {});
    parallel_for(conditions, threads_,
                 [&](std::size_t i) { own[i] = squares_at(i, effects, z, at); });
    Part total = priors_at(z, all);
    for (const Part& each : own) {
      total.ok = total.ok && each.ok;
      total.squares += each.squares;
    }
    total.ok = total.ok && total.squares < below;
    if (!total.ok) return total;
    parallel_for(conditions, threads_, [&](std::size_t i) { complete(i, effects, z, at, own[i]); });
    for (const Part& each : own) {
      total.ok = total.ok && each.ok;
      if (!total.ok) return total;
      total.gradient += each.gradient;
      total.normal += each.normal;
    }
    return total;
  };
  sum = evaluate(best.z, best.sizes, HUGE_VAL, parts);
  if (!sum.ok) return std::nullopt;
  double count = 0.0;
  for (const VectorXd& each : base_) count += static_cast<double>(each.size());
  // With recorded drives, effects are simulated more coarsely. If the predicted decrease is below
  // what these simulations resolve, shorter steps are not worth trying.
  const bool recorded = std::any_of(problem_.conditions.begin(), problem_.conditions.end(),
                                    [](const auto& each) { return each.measured_tolerance > 0.0; });
  bool settled = false;
  for (int step = 0; step < kMostRefitSteps && !settled; ++step) {
    if (cancel_ != nullptr && cancel_->load()) return std::nullopt;
    // An effect that the records would make negative is kept at zero, and an unknown at a bound is
    // kept there if the cost falls outwards.
    std::vector<Index> moving;
    for (Index j = 0; j < all; ++j) {
      const bool is_unknown = j < unknowns;
      const double value =
          is_unknown ? best.z[static_cast<std::size_t>(j)] : best.sizes(j - unknowns);
      const bool bounded =
          is_unknown || effects[static_cast<std::size_t>(j - unknowns)].about.one_sided;
      const bool low = bounded && value <= 0.0 && sum.gradient(j) > 0.0;
      const bool high = is_unknown && value >= 1.0 && sum.gradient(j) < 0.0;
      if (!low && !high) moving.push_back(j);
    }
    const MatrixXd inverse = scaled_inverse(sum.normal(moving, moving));
    const VectorXd change = -inverse * sum.gradient(moving);
    const double promised = -sum.gradient(moving).dot(change);
    if (!(promised > kSettledFall * sum.squares / count)) {
      settled = true;
      break;
    }
    double part_of_step = 1.0;
    bool lower = false;
    const bool resolved = promised >= kResolvedFall * sum.squares / count;
    const int halvings = resolved || !recorded ? kMostStepHalvings : 1;
    for (int halving = 0; halving < halvings && !lower; ++halving, part_of_step *= 0.5) {
      std::vector<double> z = best.z;
      VectorXd next = best.sizes;
      for (std::size_t m = 0; m < moving.size(); ++m) {
        const double by = part_of_step * change(static_cast<Index>(m));
        if (moving[m] < unknowns) {
          double& each = z[static_cast<std::size_t>(moving[m])];
          each = std::clamp(each + by, 0.0, 1.0);
        } else {
          next(moving[m] - unknowns) += by;
        }
      }
      next = within_signs(effects, next);
      std::vector<Part> own;
      const double least_fall = kLeastFall * part_of_step * promised;
      Part there = evaluate(z, next, sum.squares - least_fall, own);
      if (!there.ok) continue;
      best.z = std::move(z);
      best.sizes = std::move(next);
      parts = std::move(own);
      sum = std::move(there);
      lower = true;
    }
    if (!lower) settled = !resolved;
    if (!lower && !settled) return std::nullopt;
  }
  if (!settled) return std::nullopt;
  best.squares = sum.squares;
  best.covariance = scaled_inverse(sum.normal);
  if (conditions < 2) return best;
  double held_out = 0.0;
  for (const Part& each : parts) {
    const VectorXd move = scaled_inverse(sum.normal - each.normal) * each.gradient;
    held_out += each.squares + 2.0 * each.gradient.dot(move) + move.dot(each.normal * move);
  }
  best.held_out = held_out;
  return best;
}

}  // namespace rigcal::calib
