#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calib/problem/evaluation.hpp"
#include "calib/search/fit_options.hpp"

namespace rigcal::calib {

/// One iteration of a descent.
struct DescentStep {
  int number = 0;
  double cost = 0.0;
  double relative_change = 0.0;  ///< of the cost
  double seconds = 0.0;          ///< since the descent began
};

/// What is minimised, and how far.
struct DescentOptions {
  /// Residuals and their derivatives at a point of the unit box; none where it cannot be evaluated.
  /// Of the Jacobian only where it is asked for.
  std::function<std::optional<Linearisation>(std::span<const double> z, bool jacobian)> linearise;
  Eigen::Index residuals = 0;      ///< how many
  std::vector<bool> active_bound;  ///< unknowns that stay where they are
  double trust_radius = 0.0;       ///< of the first step
  int most_iterations = 0;
  double function_tolerance = kFunctionTolerance;
  double parameter_tolerance = 1e-9;
  /// Told of every iteration; true ends the descent. May be empty.
  std::function<bool(const DescentStep&)> enough;
};

/// How a descent ended.
struct Descent {
  bool converged = false;  ///< by the tolerances, or enough() said so
  int iterations = 0;      ///< steps tried, the start not counted
  std::string failure;     ///< why it gave up; else empty
};

/// Least squares in the unit box by Ceres, from z to where it ends: trust region, dense QR. What
/// the functions throw is thrown again, past Ceres.
Descent descend(const DescentOptions& options, std::vector<double>& z);

}  // namespace rigcal::calib
