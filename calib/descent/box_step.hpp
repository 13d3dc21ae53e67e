#pragma once

#include <Eigen/Core>

#include "calib/problem/arrow.hpp"

namespace rigcal::calib {

/// Quadratic model of the change in cost for a step p: gradient' p + p' hessian p / 2.
struct QuadraticModel {
  ArrowSquare hessian;  ///< may be indefinite, except in the blocks of the conditions
  Eigen::VectorXd gradient;

  /// Returns the reduction in cost that the model predicts for a step.
  double fall(const Eigen::VectorXd& step) const {
    return -gradient.dot(step) - 0.5 * step.dot(hessian * step);
  }
};

/// Limits of a step: lower <= p <= upper and |scale p| <= radius. All vectors have shape
/// (unknowns), with lower <= 0 <= upper and scale > 0.
struct StepLimits {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
  Eigen::VectorXd scale;
  double radius = 0.0;
};

struct BoxStep {
  Eigen::VectorXd step;
  double fall = 0.0;       ///< reduction predicted by the model; never negative
  bool at_radius = false;  ///< true if a larger trust region would allow a longer step
};

/// Returns -(B + damping)^-1 c for a positive semidefinite matrix B.
Eigen::VectorXd damped_step(const ArrowSquare& b, const Eigen::VectorXd& c, double damping);

/// Minimises the model exactly within the trust region (Moré and Sorensen, SIAM J. Sci. Stat.
/// Comput. 4, 1983), and within the bounds by an active-set method: an unknown that reaches its
/// bound is fixed there, and the system is solved again for the others. An unknown that the model
/// would move back inside is released, but only once. Eigenvalues are affordable, because few
/// unknowns remain once those of the conditions have been eliminated.
BoxStep box_step(const QuadraticModel& model, const StepLimits& limits);

}  // namespace rigcal::calib
