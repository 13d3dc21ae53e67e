#include "calib/descent/box_step.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

namespace rigcal::calib {
namespace {

/// Eigenvalues below this fraction of the largest are rounding errors. The fraction is this small
/// because the eigenvalues of J'J are squares of singular values.
constexpr double kSquaredRounding = 1e-12;
/// Relative tolerance for a step that ends on the boundary of the trust region. The limit on
/// iterations is never reached, because Newton's method takes three or four.
constexpr double kOnRadius = 1e-8;
constexpr int kMostRadiusIterations = 100;

struct BallStep {
  Eigen::VectorXd step;
  double multiplier = 0.0;  ///< multiplier of the constraint on the radius; 0 inside the ball
};

/// Replaces eigenvalues that are only rounding errors by a small value, because the model is flat
/// in these directions.
Eigen::VectorXd without_rounding(const Eigen::VectorXd& eigenvalues, double flat) {
  return eigenvalues.unaryExpr(
      [flat](double value) { return std::abs(value) <= flat ? flat : value; });
}

/// (B + shift)^-1 for a dense matrix, in the coordinates of its eigenvectors.
class ShiftedDense {
 public:
  explicit ShiftedDense(const Eigen::MatrixXd& b) : spectrum_(b) {
    const double flat = kSquaredRounding * spectrum_.eigenvalues().cwiseAbs().maxCoeff() + 1e-300;
    curvature_ = without_rounding(spectrum_.eigenvalues(), flat);
    least_ = std::max(0.0, -curvature_(0));
    // Shifts are measured from the value at which the matrix becomes semidefinite, to avoid
    // cancellation there.
    curvature_.array() += least_;
  }

  /// Returns the smallest shift that makes the matrix semidefinite. The functions below add the
  /// shift that they are given to this value.
  double least() const { return least_; }
  Eigen::VectorXd into(const Eigen::VectorXd& x) const {
    return spectrum_.eigenvectors().transpose() * x;
  }
  Eigen::VectorXd back(const Eigen::VectorXd& y) const { return spectrum_.eigenvectors() * y; }
  Eigen::VectorXd solve(const Eigen::VectorXd& y, double more) const {
    return (y.array() / (curvature_.array() + more).max(1e-300)).matrix();
  }
  /// Returns half the derivative of -|y|^2 with respect to the shift, where y is the solution for
  /// x.
  double slope(const Eigen::VectorXd& x, const Eigen::VectorXd& /*y*/, double more) const {
    return (x.array().square() / (curvature_.array() + more).max(1e-300).cube()).sum();
  }
  /// Returns the unit vector with the most negative curvature.
  Eigen::VectorXd lowest() const { return Eigen::VectorXd::Unit(curvature_.size(), 0); }

 private:
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum_;
  Eigen::VectorXd curvature_;
  double least_ = 0.0;
};

/// (B + shift)^-1 for an arrow matrix. The unknowns of each block are eliminated using the
/// eigenvectors of the block; the reduced system for the shared unknowns is solved using its
/// eigenvalues.
class ShiftedArrow {
 public:
  explicit ShiftedArrow(const ArrowSquare& b)
      : b_(b),
        spectra_(b.layout.own.size()),
        coupling_(b.layout.own.size()),
        curvature_(b.layout.own.size()) {
    double largest = b.blocks.shared.size() > 0 ? b.blocks.shared.cwiseAbs().maxCoeff() : 0.0;
    for (std::size_t i = 0; i < spectra_.size(); ++i) {
      if (b.layout.own[i].empty()) continue;
      spectra_[i].compute(b.blocks.own[i]);
      coupling_[i] = spectra_[i].eigenvectors().transpose() * b.blocks.coupling[i];
      curvature_[i] = spectra_[i].eigenvalues();
      largest = std::max(largest, curvature_[i].cwiseAbs().maxCoeff());
    }
    flat_ = kSquaredRounding * largest + 1e-300;
    for (Eigen::VectorXd& each : curvature_) each = without_rounding(each, flat_);
    find_least();
  }

  double least() const { return least_; }
  static const Eigen::VectorXd& into(const Eigen::VectorXd& x) { return x; }
  static const Eigen::VectorXd& back(const Eigen::VectorXd& y) { return y; }

  Eigen::VectorXd solve(const Eigen::VectorXd& x, double more) const {
    const double shift = least_ + more;
    Eigen::VectorXd left = x(b_.layout.shared);
    std::vector<Eigen::VectorXd> own(spectra_.size());
    for (std::size_t i = 0; i < spectra_.size(); ++i) {
      if (curvature_[i].size() == 0) continue;
      const Eigen::VectorXd in_block = x(b_.layout.own[i]);
      own[i] = spectra_[i].eigenvectors().transpose() * in_block;
      left -= coupling_[i].transpose() * over(own[i], i, shift);
    }
    Eigen::VectorXd result(x.size());
    Eigen::VectorXd of_shared(left.size());
    if (left.size() > 0) {
      const Spectrum spectrum(schur(shift));
      const Eigen::VectorXd curvature = without_rounding(spectrum.eigenvalues(), flat_);
      of_shared = spectrum.eigenvectors() * ((spectrum.eigenvectors().transpose() * left).array() /
                                             curvature.array().max(1e-300))
                                                .matrix();
    }
    result(b_.layout.shared) = of_shared;
    for (std::size_t i = 0; i < spectra_.size(); ++i) {
      if (curvature_[i].size() == 0) continue;
      result(b_.layout.own[i]) =
          spectra_[i].eigenvectors() * over(own[i] - coupling_[i] * of_shared, i, shift);
    }
    return result;
  }

  double slope(const Eigen::VectorXd& /*x*/, const Eigen::VectorXd& y, double more) const {
    return y.dot(solve(y, more));
  }

  Eigen::VectorXd lowest() const {
    const Eigen::VectorXd of_shared = Spectrum(schur(least_)).eigenvectors().col(0);
    Eigen::VectorXd result(b_.size());
    result(b_.layout.shared) = of_shared;
    for (std::size_t i = 0; i < spectra_.size(); ++i) {
      if (curvature_[i].size() > 0)
        result(b_.layout.own[i]) =
            -spectra_[i].eigenvectors() * over(coupling_[i] * of_shared, i, least_);
    }
    return result.normalized();
  }

 private:
  using Spectrum = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

  Eigen::VectorXd over(const Eigen::VectorXd& x, std::size_t i, double shift) const {
    return x.cwiseQuotient((curvature_[i].array() + shift).matrix());
  }

  /// Returns the reduced matrix of the shared unknowns for a given shift.
  Eigen::MatrixXd schur(double shift) const {
    Eigen::MatrixXd result = b_.blocks.shared;
    result.diagonal().array() += shift;
    for (std::size_t i = 0; i < spectra_.size(); ++i) {
      if (curvature_[i].size() == 0) continue;
      const Eigen::VectorXd inverse = (curvature_[i].array() + shift).inverse();
      result -= coupling_[i].transpose() * inverse.asDiagonal() * coupling_[i];
    }
    return result;
  }

  /// Finds the smallest shift without negative eigenvalues by bisection. B + shift has as many
  /// negative eigenvalues as the Schur complement, because the blocks of the conditions have none.
  void find_least() {
    if (b_.blocks.shared.size() == 0) return;
    const auto lowest_at = [&](double shift) {
      return Spectrum(schur(shift), Eigen::EigenvaluesOnly).eigenvalues()(0);
    };
    const double curvature = lowest_at(0.0);
    if (curvature >= -flat_) return;
    double low = 0.0;
    double high = -curvature;  // the complement grows at least as fast as the shift
    for (int k = 0; k < kMostRadiusIterations && high - low > 1e-15 * high; ++k) {
      const double middle = 0.5 * (low + high);
      (lowest_at(middle) < 0.0 ? low : high) = middle;
    }
    least_ = high;
  }

  const ArrowSquare& b_;
  std::vector<Spectrum> spectra_;  ///< one per block of a condition
  std::vector<Eigen::MatrixXd> coupling_;
  std::vector<Eigen::VectorXd> curvature_;
  double flat_ = 0.0;
  double least_ = 0.0;
};

/// Minimises c' y + y' B y / 2 over |y| <= radius.
template <typename Shifted>
BallStep ball_step(const Shifted& b, const Eigen::VectorXd& c, double radius) {
  const Eigen::VectorXd along = b.into(c);
  double more = 0.0;
  Eigen::VectorXd y = b.solve(along, more);
  if (b.least() > 0.0 || y.norm() > radius) {
    double low = 0.0;
    double high = along.norm() / radius;
    more = std::clamp(1e-3 * high, low, high);
    for (int k = 0; k < kMostRadiusIterations; ++k) {
      y = b.solve(along, more);
      const double length = y.norm();
      if (std::abs(length - radius) <= kOnRadius * radius) break;
      (length > radius ? low : high) = more;
      // Newton's method for 1 / length, which is almost linear in the shift.
      const double slope = b.slope(along, y, more);
      const double next =
          more + (length / radius - 1.0) * length * length / std::max(slope, 1e-300);
      more = next > low && next < high ? next : 0.5 * (low + high);
      if (high - low <= 1e-15 * high) break;
    }
    y = b.solve(along, more);
  }
  y = -y;
  // The gradient has no component along the most negative curvature, so the rest of the step goes
  // in that direction.
  const double short_of = radius * radius - y.squaredNorm();
  if (b.least() > 0.0 && short_of > 2.0 * kOnRadius * radius * radius) {
    const Eigen::VectorXd lowest = b.lowest();
    const double part = lowest.dot(y);
    y += std::copysign(std::sqrt(short_of + part * part) - std::abs(part), part) * lowest;
  }
  return {b.back(y), b.least() + more};
}

BallStep ball_step(const ArrowSquare& b, const Eigen::VectorXd& c, double radius) {
  if (b.layout.own.empty()) return ball_step(ShiftedDense(b.blocks.shared), c, radius);
  return ball_step(ShiftedArrow(b), c, radius);
}

}  // namespace

Eigen::VectorXd damped_step(const ArrowSquare& b, const Eigen::VectorXd& c, double damping) {
  if (!b.layout.own.empty()) return -ShiftedArrow(b).solve(c, damping);
  Eigen::MatrixXd damped = b.blocks.shared;
  damped.diagonal().array() += damping;
  return -damped.llt().solve(c);
}

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
          ball_step(model.hessian.part(free, inverse), inverse.cwiseProduct(slope(free)), radius);
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
    // If the model is indefinite, a step along the bounds may increase the cost again.
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
