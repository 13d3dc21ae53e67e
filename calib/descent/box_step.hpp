#pragma once

#include <Eigen/Core>

#include "calib/problem/arrow.hpp"

namespace rigcal::calib {

/// Model of how a cost changes with a step p: gradient' p + p' hessian p / 2.
struct QuadraticModel {
  ArrowSquare hessian;  ///< may be indefinite, but not in the block of a condition
  Eigen::VectorXd gradient;

  /// Fall of the cost that the model predicts for a step.
  double fall(const Eigen::VectorXd& step) const {
    return -gradient.dot(step) - 0.5 * step.dot(hessian * step);
  }
};

/// Limits of a step: lower <= p <= upper and |scale p| <= radius. All have the shape (unknowns);
/// lower <= 0 <= upper, scale > 0.
struct StepLimits {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
  Eigen::VectorXd scale;
  double radius = 0.0;
};

struct BoxStep {
  Eigen::VectorXd step;
  double fall = 0.0;       ///< predicted by the model; never negative
  bool at_radius = false;  ///< a larger trust region would give a longer step
};

/// -(B + damping)^-1 c, of a matrix that is not indefinite.
Eigen::VectorXd damped_step(const ArrowSquare& b, const Eigen::VectorXd& c, double damping);

/// The least of a model in the ball, exactly, and then in the box by an active set: an unknown that
/// meets its bound stays there and the others are solved for again; one that the model draws back
/// inside is let go, once (Moré and Sorensen, SIAM J. Sci. Stat. Comput. 4, 1983; by eigenvalues,
/// since there are few unknowns once those of the conditions are eliminated).
BoxStep box_step(const QuadraticModel& model, const StepLimits& limits);

}  // namespace rigcal::calib
