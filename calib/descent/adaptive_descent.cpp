#include "calib/descent/adaptive_descent.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "calib/descent/box_step.hpp"

namespace rigcal::calib {
namespace {

/// A step is accepted if the reduction in cost exceeds this fraction of the prediction. The value
/// is that of Ceres.
constexpr double kTaken = 1e-3;
/// Limits for the ratio of actual to predicted reduction. Below the first, the trust region shrinks
/// to a fraction of the step; above the second, it grows.
constexpr double kPoorGain = 0.25;
constexpr double kGoodGain = 0.75;
constexpr double kRadiusGrowth = 2.0;
constexpr double kLeastShrink = 0.1;
constexpr double kMostShrink = 0.5;
/// The other model is used for the next step if its prediction error is smaller by this factor. The
/// value is that of NL2SOL.
constexpr double kNearer = 1.5;
/// Minimum ratio of an unknown's scale to its scale at the previous point. The value is that of
/// NL2SOL.
constexpr double kScaleMemory = 0.6;
/// Minimum scale relative to the largest scale, and minimum cosine of the angle between a step and
/// the change in the gradient.
constexpr double kLeastScale = 1e-6;
constexpr double kLeastCosine = 1e-6;
/// A rejected step ends the descent if both the predicted and the actual change in cost are below
/// this fraction of the cost, because simulations are not accurate enough to resolve it.
constexpr double kNoise = 1e-8;
/// The descent gives up after this many consecutive points that cannot be evaluated. By then the
/// step is a millionth of the first one.
constexpr int kMostInvalid = 10;

struct Point {
  Eigen::VectorXd z;
  double cost = 0.0;
  Eigen::VectorXd gradient;
  ArrowSquare square;  ///< J'J
};

std::optional<Point> point_at(const DescentOptions& options, const Eigen::VectorXd& z) {
  const auto found =
      options.linearise({z.data(), static_cast<std::size_t>(z.size())}, /*jacobian=*/true);
  if (!found) return std::nullopt;
  return Point{z, 0.5 * found->square(), found->gradient(), found->normal()};
}

/// Updates S after a step as proposed by Dennis, Gay and Welsch: the new S maps the step to the
/// change in the gradient that J'J does not explain, and is otherwise as close as possible to the
/// previous S. S covers only the shared unknowns, because a full S would couple the own unknowns of
/// different conditions.
void learn(const Point& from, const Point& to, const Eigen::VectorXd& scales, Eigen::MatrixXd& s) {
  const std::vector<int>& shared = from.square.layout.shared;
  const Eigen::VectorXd whole = to.z - from.z;
  const Eigen::VectorXd explained = to.square.mean(from.square) * whole;
  const Eigen::VectorXd step = whole(shared);
  const Eigen::VectorXd scale = scales(shared);
  const Eigen::VectorXd change = to.gradient(shared) - from.gradient(shared);
  const Eigen::VectorXd unexplained = change - explained(shared);
  // Sizing: S was estimated where the residuals were larger, and may now be too large.
  const double before = std::abs(step.dot(s * step));
  if (before > 0.0) s *= std::min(1.0, std::abs(step.dot(unexplained)) / before);
  const double along = change.dot(step);
  const double least =
      kLeastCosine * scale.cwiseProduct(step).norm() * change.cwiseQuotient(scale).norm();
  if (along == 0.0 || !(least > 0.0)) return;
  const Eigen::VectorXd weight = change * (std::min(1.0, std::abs(along) / least) / along);
  const Eigen::VectorXd error = unexplained - s * step;
  const Eigen::MatrixXd half = error * weight.transpose();
  s += half + half.transpose() - error.dot(step) * weight * weight.transpose();
}

/// Updates the scales. They are the column norms of the Jacobian, but may decrease only slowly from
/// one point to the next.
void rescale(const Point& at, Eigen::VectorXd& scale) {
  scale = at.square.diagonal().cwiseSqrt().cwiseMax(kScaleMemory * scale);
  scale = scale.cwiseMax(std::max(kLeastScale * scale.maxCoeff(), 1e-150));
}

/// Returns the length of the Levenberg-Marquardt step, in units of the scale.
double damped_length(const Point& at, const Eigen::VectorXd& scale, double damping) {
  const Eigen::VectorXd inverse = scale.cwiseInverse();
  std::vector<Eigen::Index> all(static_cast<std::size_t>(scale.size()));
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  return damped_step(at.square.part(all, inverse), inverse.cwiseProduct(at.gradient), damping)
      .norm();
}

/// Returns the fraction of a step at which the cost is lowest, from a parabola through the slope
/// and the actual reduction.
double least_along(double slope, double actual_fall) {
  const double curvature = -actual_fall - slope;
  return curvature > 0.0 ? std::clamp(-0.5 * slope / curvature, kLeastShrink, kMostShrink)
                         : kMostShrink;
}

}  // namespace

Descent descend_adaptively(const DescentOptions& options, std::vector<double>& z) {
  const auto began = std::chrono::steady_clock::now();
  Descent result;
  const auto enough = [&](double cost, double relative_change) {
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - began;
    return options.enough &&
           options.enough({result.iterations, cost, relative_change, taken.count()});
  };
  const auto n = static_cast<Eigen::Index>(z.size());
  auto here = point_at(options, Eigen::Map<const Eigen::VectorXd>(z.data(), n));
  if (!here) {
    result.failure = "the optimiser gave up: the start cannot be evaluated";
    return result;
  }
  Eigen::VectorXd scale = Eigen::VectorXd::Zero(n);
  rescale(*here, scale);
  double radius = damped_length(*here, scale, 1.0 / options.trust_radius);
  const Eigen::Index shared = here->square.blocks.shared.rows();
  Eigen::MatrixXd second = Eigen::MatrixXd::Zero(shared, shared);  // S
  bool augmented = false;
  bool switched = false;  // the other model has been tried at this point, too
  int invalid = 0;
  bool ended = enough(here->cost, 0.0);
  while (!ended && !result.converged && result.iterations < options.most_iterations) {
    const QuadraticModel plain{here->square, here->gradient};
    QuadraticModel full = plain;
    full.hessian.blocks.shared += second;
    const BoxStep tried = box_step(augmented ? full : plain,
                                   {-here->z, Eigen::VectorXd::Ones(n) - here->z, scale, radius});
    const double length = scale.cwiseProduct(tried.step).norm();
    const double shortest =
        options.parameter_tolerance * (here->z.norm() + options.parameter_tolerance);
    result.converged = tried.fall <= 0.0 || tried.step.norm() <= shortest;
    if (result.converged) break;
    ++result.iterations;
    auto there = point_at(options, (here->z + tried.step).cwiseMax(0.0).cwiseMin(1.0));
    if (!there) {
      ended = enough(here->cost, 0.0);
      radius = kMostShrink * kMostShrink * length;
      if (++invalid < kMostInvalid) continue;
      result.failure = "the optimiser gave up: no neighbouring point can be evaluated";
      break;
    }
    invalid = 0;
    const double fall = here->cost - there->cost;
    const double gain = fall / tried.fall;
    const double other = (augmented ? plain : full).fall(tried.step);
    const bool other_nearer = kNearer * std::abs(fall - other) < std::abs(fall - tried.fall);
    learn(*here, *there, scale, second);  // rejected steps provide information, too
    if (gain <= kTaken) {
      ended = enough(here->cost, 0.0);
      result.converged = std::max(std::abs(fall), tried.fall) <= kNoise * here->cost;
      if (other_nearer && !switched) {
        augmented = !augmented;
        switched = true;
      } else {
        radius = length * least_along(here->gradient.dot(tried.step), fall);
      }
      continue;
    }
    if (gain < kPoorGain) {
      radius = length * least_along(here->gradient.dot(tried.step), fall);
    } else if (gain > kGoodGain) {
      radius = std::max(radius, kRadiusGrowth * length);
    }
    if (other_nearer) augmented = !augmented;
    switched = false;
    const double relative = fall / here->cost;
    here = std::move(there);
    rescale(*here, scale);
    ended = enough(here->cost, relative);
    result.converged = !tried.at_radius && relative <= options.function_tolerance &&
                       tried.fall <= options.function_tolerance * here->cost;
  }
  Eigen::Map<Eigen::VectorXd>(z.data(), n) = here->z;
  return result;
}

}  // namespace rigcal::calib
