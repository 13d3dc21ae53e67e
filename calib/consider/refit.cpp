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
/// With recorded drives a step is shortened at most this often, each time to the minimum of the
/// parabola through both ends, but not below this fraction.
constexpr int kMostShortenings = 1;
constexpr double kLeastPart = 0.03;
/// The search ends when the predicted decrease in the sum of squares is below this, in variances of
/// a weighted residual.
constexpr double kSettledFall = 0.02;
/// A step is accepted only if the actual decrease is at least this fraction of the predicted one.
/// Close to a kink the derivatives predict decreases that no step achieves, and tiny decreases
/// would continue until the last iteration.
constexpr double kLeastFall = 0.01;
/// Smallest decrease that the simulations resolve, in variances of a weighted residual. With
/// recorded drives, whose effects are simulated more coarsely, a step with a smaller predicted
/// decrease is taken without a simulation.
constexpr double kResolvedFall = 1.0;
/// The sensitivities are used again in the next step if the decrease that they would miss is
/// expected to be below this, in the same unit. A Hessian with a relative error e misses e^2 of the
/// predicted decrease.
constexpr double kLeftFall = 0.1;
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

/// Returns the fraction of a failed step at which the parabola through both ends has its minimum,
/// at most a half.
///
/// @param promised  half the decrease that the slope at the start predicts for the step
/// @param rise      increase in the squares at its end
double shorter_part(double promised, double rise) {
  const double curvature = rise + 2.0 * promised;
  return curvature > 0.0 ? std::min(0.5, promised / curvature) : 0.5;
}

/// Returns the derivatives of the weighted outputs with respect to the acting unknowns and the
/// effects of a sensor. The columns of the other effects are not set.
MatrixXd derivatives_of(const Problem& problem, std::size_t condition,
                        const std::vector<Effect>& effects, std::span<const double> z,
                        const OutputsWith& with) {
  const VectorXd slopes = acting_slopes(problem, condition, z);
  MatrixXd jacobian(with.outputs.size(), slopes.size() + with.by_sensor.cols());
  jacobian.leftCols(slopes.size()) = with.jacobian * slopes.asDiagonal();
  for (Index e = 0; e < with.by_sensor.cols(); ++e) {
    if (effects[static_cast<std::size_t>(e)].is_of_sensor())
      jacobian.col(slopes.size() + e) = with.by_sensor.col(e);
  }
  return jacobian;
}

}  // namespace

Refitter::Refitter(const Problem& problem, std::span<const double> z,
                   const std::vector<ScoreRows>& scores, int threads,
                   const std::atomic<bool>* cancel)
    : problem_(problem),
      scores_(scores),
      threads_(threads),
      cancel_(cancel),
      recorded_(std::any_of(problem.conditions.begin(), problem.conditions.end(),
                            [](const auto& each) { return each.measured_tolerance > 0.0; })),
      base_(problem.conditions.size()) {
  // Derivatives change the error control, so the outputs are those of the runs that are compared.
  const Derivatives derivatives = recorded_ ? Derivatives::none : Derivatives::of_unknowns;
  parallel_for(base_.size(), threads, [&](std::size_t i) {
    base_[i] = outputs_with(problem, i, z, {}, VectorXd::Zero(0), derivatives, cancel).outputs;
  });
}

Refitter::Part Refitter::squares_at(std::size_t condition, const std::vector<Effect>& effects,
                                    std::span<const double> z, const VectorXd& sizes) const {
  Part part;
  const OutputsWith with =
      outputs_with(problem_, condition, z, effects, sizes,
                   recorded_ ? Derivatives::none : Derivatives::of_unknowns, cancel_);
  if (!with.ok() || base_[condition].size() == 0) return part;
  part.residual = scores_[condition].residual + with.outputs - base_[condition];
  if (!recorded_) part.jacobian = derivatives_of(problem_, condition, effects, z, with);
  part.squares = part.residual.squaredNorm();
  part.ok = std::isfinite(part.squares);
  return part;
}

void Refitter::derive(std::size_t condition, const std::vector<Effect>& effects,
                      std::span<const double> z, const VectorXd& sizes, Part& part) const {
  const auto run = [&](const VectorXd& at, Derivatives derivatives) {
    return outputs_with(problem_, condition, z, effects, at, derivatives, cancel_);
  };
  // Both runs of a difference are made without derivatives, because derivatives change the error
  // control.
  std::optional<VectorXd> here;
  if (recorded_) {
    const OutputsWith with = run(sizes, Derivatives::of_unknowns);
    part.ok = with.ok();
    if (!part.ok) return;
    part.jacobian = derivatives_of(problem_, condition, effects, z, with);
    here = part.residual - scores_[condition].residual + base_[condition];
  }
  for (Index e = 0; e < sizes.size(); ++e) {
    if (effects[static_cast<std::size_t>(e)].is_of_sensor()) continue;
    if (!here) here = run(sizes, Derivatives::none).outputs;
    VectorXd further = sizes;
    further(e) += kEffectStep;
    const OutputsWith there = run(further, Derivatives::none);
    part.ok = here->size() > 0 && there.ok();
    if (!part.ok) return;
    part.jacobian.col(part.jacobian.cols() - sizes.size() + e) =
        (there.outputs - *here) / kEffectStep;
  }
  if (recorded_) part.kept = part.jacobian.cast<float>();
}

void Refitter::project(std::size_t condition, std::size_t unknowns, Index effects,
                       Part& part) const {
  const std::vector<int>& acting = problem_.map.acting(condition);
  std::vector<Index> columns(acting.begin(), acting.end());
  const auto all = static_cast<Index>(unknowns);
  for (Index e = 0; e < effects; ++e) columns.push_back(all + e);
  part.gradient = VectorXd::Zero(all + effects);
  part.normal = MatrixXd::Zero(all + effects, all + effects);
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
  double count = 0.0;
  for (const VectorXd& each : base_) count += static_cast<double>(each.size());
  std::vector<Part> parts;
  Part sum;
  // Derivatives are simulated only if the point is accepted, and only if those of the previous
  // point are not good enough.
  const auto evaluate = [&](std::span<const double> z, const VectorXd& at, double below,
                            double promised, std::vector<Part>& own) {
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
    const double missed = sum.squares - total.squares - promised;
    const bool kept = recorded_ && missed * missed <= kLeftFall * promised * total.squares / count;
    parallel_for(conditions, threads_, [&](std::size_t i) {
      if (kept) {
        own[i].kept = parts[i].kept;
        own[i].jacobian = own[i].kept.cast<double>();
      } else {
        derive(i, effects, z, at, own[i]);
      }
      if (own[i].ok) project(i, z.size(), at.size(), own[i]);
    });
    for (const Part& each : own) {
      total.ok = total.ok && each.ok;
      if (!total.ok) return total;
      total.gradient += each.gradient;
      total.normal += each.normal;
    }
    return total;
  };
  sum = evaluate(best.z, best.sizes, HUGE_VAL, 0.0, parts);
  if (!sum.ok) return std::nullopt;
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
    const auto stepped = [&](double part_of_step, std::vector<double>& z, VectorXd& next) {
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
    };
    double part_of_step = 1.0;
    bool lower = false;
    const bool resolved = promised >= kResolvedFall * sum.squares / count;
    if (recorded_ && !resolved) {
      std::vector<double> z = best.z;
      VectorXd next = best.sizes;
      stepped(1.0, z, next);
      VectorXd last(all);
      for (Index j = 0; j < unknowns; ++j)
        last(j) = z[static_cast<std::size_t>(j)] - best.z[static_cast<std::size_t>(j)];
      last.tail(next.size()) = next - best.sizes;
      if (sum.linear_change(last) < 0.0) {
        best.z = std::move(z);
        best.sizes = std::move(next);
        sum.take(last);
        for (Part& each : parts) each.take(last);
      }
      settled = true;
      break;
    }
    const int tries = recorded_ ? 1 + kMostShortenings : kMostStepHalvings;
    for (int attempt = 0; attempt < tries && !lower; ++attempt) {
      std::vector<double> z = best.z;
      VectorXd next = best.sizes;
      stepped(part_of_step, z, next);
      std::vector<Part> own;
      const double least_fall = kLeastFall * part_of_step * promised;
      Part there = evaluate(z, next, sum.squares - least_fall, promised, own);
      if (!there.ok) {
        part_of_step *=
            recorded_ ? shorter_part(promised * part_of_step, there.squares - sum.squares) : 0.5;
        if (part_of_step < kLeastPart) break;
        continue;
      }
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
