#include "calib/search/optimum.hpp"

#include <algorithm>
#include <cmath>

#include "calib/problem/arrow_svd.hpp"

namespace rigcal::calib {
namespace {

/// Largest relative offset of a stationary point, in standard errors; see OptimumCheck.
constexpr double kStationary = 0.01;

}  // namespace

BoundSide bound_side(double z) {
  if (z <= kAtBound) return BoundSide::lower;
  return z >= 1.0 - kAtBound ? BoundSide::upper : BoundSide::inside;
}

double rank_threshold(double simulation_tolerance) {
  return std::clamp(50.0 * simulation_tolerance, 1e-8, 1e-4);
}

bool OptimumCheck::stationary() const { return relative_offset <= kStationary && is_minimum(); }
bool OptimumCheck::is_minimum() const { return fall_left <= kMinimumLeaves; }

std::vector<bool> active_bounds(const Linearisation& system, std::span<const double> z) {
  const Eigen::VectorXd gradient = system.gradient();
  std::vector<bool> active;
  for (std::size_t j = 0; j < z.size(); ++j) {
    const double slope = gradient(static_cast<Eigen::Index>(j));
    const BoundSide side = bound_side(z[j]);
    active.push_back((side == BoundSide::lower && slope > 0.0) ||
                     (side == BoundSide::upper && slope < 0.0));
  }
  return active;
}

OptimumCheck check_optimum(const Problem& problem, const Evaluation& evaluation) {
  Linearisation system = linearise(problem, evaluation);
  OptimumCheck check;
  check.active_bound = active_bounds(system, evaluation.z);
  for (const double z : evaluation.z) check.side.push_back(bound_side(z));
  system.hold(check.active_bound);
  const ArrowSvd svd(system, rank_threshold(problem.tolerance));
  check.step = svd.step();
  const auto rank = static_cast<double>(svd.rank());
  const double explained = svd.explained();
  const double all = system.square();
  const double residuals = evaluation.share * static_cast<double>(problem.residual_count());
  const double freedom = std::max(1.0, residuals - rank);
  const double unexplained = std::sqrt(std::max(0.0, all - explained));
  const double noise = std::max(problem.least_noise(), unexplained / std::sqrt(freedom));
  check.relative_offset = std::sqrt(explained / std::max(rank, 1.0)) / noise;
  check.fall_left = 0.5 * explained / (noise * noise);
  if (all > 0.0) check.reducible = explained / all;
  return check;
}

}  // namespace rigcal::calib
