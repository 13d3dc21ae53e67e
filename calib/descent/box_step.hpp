#pragma once

#include <Eigen/Core>

namespace rigcal::calib {

/// Model of how a cost changes with a step p: gradient' p + p' hessian p / 2.
struct QuadraticModel {
  Eigen::MatrixXd hessian;  ///< symmetric; may be indefinite
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

/// Minimises a model in the ball, exactly, and then in the box by an active set. An unknown that
/// meets its bound stays there while the others are solved for again. An unknown that the model
/// pulls back inside is released, once. The solution in the ball follows Moré and Sorensen (SIAM J.
/// Sci. Stat. Comput. 4, 1983), by eigenvalues since there are few unknowns.
BoxStep box_step(const QuadraticModel& model, const StepLimits& limits);

}  // namespace rigcal::calib
