#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "calib/problem/evaluation.hpp"

namespace rigcal::calib {

/// Relative change in cost below which a search at the working tolerance has converged.
inline constexpr double kFunctionTolerance = 1e-10;

/// One iteration of a descent.
struct DescentStep {
  int number = 0;
  double cost = 0.0;
  double relative_change = 0.0;
  double seconds = 0.0;  ///< time since the descent began
};

/// The function to minimise, and when to stop.
struct DescentOptions {
  /// Returns the residuals at a point in the unit box, or std::nullopt if it cannot be evaluated.
  /// The Jacobian is computed only on request.
  std::function<std::optional<Linearisation>(std::span<const double> z, bool jacobian)> linearise;
  double trust_radius = 0.0;  ///< radius of the first step: 1 / Levenberg-Marquardt damping
  int most_iterations = 0;
  double function_tolerance = kFunctionTolerance;
  double parameter_tolerance = 1e-9;
  /// Called after every iteration, with the start as number 0. Returns true to end the descent. May
  /// be empty.
  std::function<bool(const DescentStep&)> enough;
};

/// Result of a descent.
struct Descent {
  bool converged = false;  ///< true if a tolerance was reached
  int iterations = 0;      ///< number of steps that were tried, not counting the start
  std::string failure;     ///< why the descent gave up; otherwise empty
};

}  // namespace rigcal::calib
