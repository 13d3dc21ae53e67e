#include "calib/search/optimum.hpp"

#include <algorithm>
#include <cmath>

#include "calib/problem/svd.hpp"

namespace rigcal::calib {
namespace {

constexpr double kStationary = 0.01;  // of a standard error
constexpr double kNearlyStationary = 0.05;

}  // namespace

BoundSide bound_side(double z) {
  if (z <= kAtBound) return BoundSide::lower;
  return z >= 1.0 - kAtBound ? BoundSide::upper : BoundSide::inside;
}

double rank_threshold(double simulation_tolerance) {
  return std::clamp(50.0 * simulation_tolerance, 1e-8, 1e-4);
}

bool OptimumCheck::stationary() const { return relative_offset <= kStationary; }
bool OptimumCheck::nearly_stationary() const { return relative_offset <= kNearlyStationary; }

OptimumCheck check_optimum(const Problem& problem, const Evaluation& evaluation) {
  const Linearisation system = linearise(problem, evaluation);
  const Eigen::VectorXd gradient = system.jacobian.transpose() * system.residual;
  OptimumCheck check;
  std::vector<Eigen::Index> free;
  for (std::size_t j = 0; j < evaluation.z.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    const BoundSide side = bound_side(evaluation.z[j]);
    const bool outward = (side == BoundSide::lower && gradient(column) > 0.0) ||
                         (side == BoundSide::upper && gradient(column) < 0.0);
    check.side.push_back(side);
    check.active_bound.push_back(outward);
    if (!outward && system.jacobian.col(column).norm() > 0.0) free.push_back(column);
  }
  if (free.empty()) return check;

  Eigen::MatrixXd scaled = system.jacobian(Eigen::all, free);
  const Eigen::VectorXd norms = scaled.colwise().norm();
  scaled.array().rowwise() /= norms.transpose().array();
  Svd svd(scaled, Eigen::ComputeThinU);
  svd.setThreshold(rank_threshold(problem.tolerance));
  const Eigen::Index rank = svd.rank();
  const Eigen::VectorXd explained = svd.matrixU().leftCols(rank).transpose() * system.residual;
  const double residuals = evaluation.share * static_cast<double>(problem.residual_count());
  const double freedom = std::max(1.0, residuals - static_cast<double>(rank));
  const double unexplained =
      std::sqrt(std::max(0.0, system.residual.squaredNorm() - explained.squaredNorm()));
  const double noise = std::max(problem.least_noise(), unexplained / std::sqrt(freedom));
  const double offset =
      explained.norm() / std::sqrt(static_cast<double>(std::max<Eigen::Index>(rank, 1)));
  check.relative_offset = offset / noise;
  if (const double all = system.residual.squaredNorm(); all > 0.0)
    check.reducible = explained.squaredNorm() / all;
  return check;
}

}  // namespace rigcal::calib
