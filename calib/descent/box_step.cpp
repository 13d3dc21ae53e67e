#include "calib/descent/box_step.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

namespace rigcal::calib {
namespace {

/// Eigenvalues below this fraction of the largest are rounding errors: the matrix is a square.
constexpr double kSquaredRounding = 1e-12;
/// Relative tolerance for a step that ends on the trust region. The limit of iterations is never
/// reached: Newton's method takes three or four.
constexpr double kOnRadius = 1e-8;
constexpr int kMostRadiusIterations = 100;

struct BallStep {
  Eigen::VectorXd step;
  double multiplier = 0.0;  ///< multiplier of the constraint on the radius; 0 inside the ball
};

/// Minimises c' y + y' B y / 2 over |y| <= radius.
BallStep ball_step(const Eigen::MatrixXd& b, const Eigen::VectorXd& c, double radius) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(b);
  const double flat = kSquaredRounding * spectrum.eigenvalues().cwiseAbs().maxCoeff() + 1e-300;
  Eigen::VectorXd curvature = spectrum.eigenvalues().unaryExpr(
      [&](double value) { return std::abs(value) <= flat ? flat : value; });
  const Eigen::VectorXd along = spectrum.eigenvectors().transpose() * c;
  // The shift is counted from the point where the matrix ceases to be indefinite, to avoid
  // cancellation.
  const double least = std::max(0.0, -curvature(0));
  curvature.array() += least;
  const auto length_at = [&](double more) {
    return (along.array() / (curvature.array() + more).max(1e-300)).matrix().norm();
  };
  double more = 0.0;
  if (least > 0.0 || length_at(0.0) > radius) {
    double low = 0.0;
    double high = along.norm() / radius;
    more = std::clamp(1e-3 * high, low, high);
    for (int k = 0; k < kMostRadiusIterations; ++k) {
      const Eigen::ArrayXd divisor = (curvature.array() + more).max(1e-300);
      const double length = (along.array() / divisor).matrix().norm();
      if (std::abs(length - radius) <= kOnRadius * radius) break;
      (length > radius ? low : high) = more;
      // Newton's method for 1 / length, which is nearly linear.
      const double slope = (along.array().square() / divisor.cube()).sum();
      const double next =
          more + (length / radius - 1.0) * length * length / std::max(slope, 1e-300);
      more = next > low && next < high ? next : 0.5 * (low + high);
      if (high - low <= 1e-15 * high) break;
    }
  }
  Eigen::VectorXd y = -(along.array() / (curvature.array() + more).max(1e-300)).matrix();
  // Hard case: the gradient has no component along the most negative curvature. The step goes on in
  // that direction up to the radius.
  const double short_of = radius * radius - y.squaredNorm();
  if (least > 0.0 && short_of > 2.0 * kOnRadius * radius * radius)
    y(0) += std::copysign(std::sqrt(short_of + y(0) * y(0)) - std::abs(y(0)), y(0));
  return {spectrum.eigenvectors() * y, least + more};
}

}  // namespace

BoxStep box_step(const QuadraticModel& model, const StepLimits& limits) {
  const Eigen::Index n = model.gradient.size();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  std::vector<bool> fixed(static_cast<std::size_t>(n), false);
  std::vector<bool> let_go(static_cast<std::size_t>(n), false);
  const auto is_fixed = [&](Eigen::Index j) { return fixed[static_cast<std::size_t>(j)]; };
  for (Eigen::Index j = 0; j < n; ++j) {
    fixed[static_cast<std::size_t>(j)] = (limits.lower(j) >= 0.0 && model.gradient(j) >= 0.0) ||
                                         (limits.upper(j) <= 0.0 && model.gradient(j) <= 0.0);
  }
  BoxStep best{x, 0.0, false};
  while (true) {
    std::vector<Eigen::Index> free;
    for (Eigen::Index j = 0; j < n; ++j) {
      if (!is_fixed(j)) free.push_back(j);
    }
    double multiplier = 0.0;
    Eigen::Index hit = -1;
    if (!free.empty()) {
      Eigen::VectorXd at_bounds = x;
      for (const Eigen::Index j : free) at_bounds(j) = 0.0;
      const double used = limits.scale.cwiseProduct(at_bounds).squaredNorm();
      const double radius = std::sqrt(
          std::max(limits.radius * limits.radius - used, 1e-24 * limits.radius * limits.radius));
      const Eigen::VectorXd inverse = limits.scale(free).cwiseInverse();
      const Eigen::VectorXd slope = model.gradient + model.hessian * at_bounds;
      const BallStep ball =
          ball_step(inverse.asDiagonal() * model.hessian(free, free) * inverse.asDiagonal(),
                    inverse.cwiseProduct(slope(free)), radius);
      multiplier = ball.multiplier;
      const Eigen::VectorXd there = inverse.cwiseProduct(ball.step);
      double reach = 1.0;
      for (std::size_t k = 0; k < free.size(); ++k) {
        const Eigen::Index j = free[k];
        const double target = there(static_cast<Eigen::Index>(k));
        const double bound = std::clamp(target, limits.lower(j), limits.upper(j));
        if (bound == target) continue;
        const double part = std::max(0.0, (bound - x(j)) / (target - x(j)));
        if (hit >= 0 && part >= reach) continue;
        reach = part;
        hit = j;
      }
      for (std::size_t k = 0; k < free.size(); ++k)
        x(free[k]) += reach * (there(static_cast<Eigen::Index>(k)) - x(free[k]));
      if (hit >= 0) {
        x(hit) = x(hit) - limits.lower(hit) < limits.upper(hit) - x(hit) ? limits.lower(hit)
                                                                         : limits.upper(hit);
        fixed[static_cast<std::size_t>(hit)] = true;
      }
    }
    // Where the model is indefinite, a step along bounds may raise the cost again.
    if (model.fall(x) > best.fall) best = {x, model.fall(x), multiplier > 0.0};
    if (hit >= 0) continue;
    const Eigen::VectorXd slope =
        model.gradient + model.hessian * x + multiplier * limits.scale.cwiseAbs2().cwiseProduct(x);
    Eigen::Index inwards = -1;
    double steepest = 0.0;
    for (Eigen::Index j = 0; j < n; ++j) {
      if (!is_fixed(j) || let_go[static_cast<std::size_t>(j)]) continue;
      const double inward = (x(j) <= limits.lower(j) ? -slope(j) : slope(j)) / limits.scale(j);
      if (limits.lower(j) >= limits.upper(j) || inward <= steepest) continue;
      steepest = inward;
      inwards = j;
    }
    if (inwards < 0) return best;
    fixed[static_cast<std::size_t>(inwards)] = false;
    let_go[static_cast<std::size_t>(inwards)] = true;
  }
}

}  // namespace rigcal::calib
