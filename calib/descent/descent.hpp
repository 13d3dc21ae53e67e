#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calib/problem/evaluation.hpp"

namespace rigcal::calib {

/// Relative change of the cost below which a search at the working tolerance has converged.
inline constexpr double kFunctionTolerance = 1e-10;

/// One iteration of a descent.
struct DescentStep {
  int number = 0;
  double cost = 0.0;
  double relative_change = 0.0;  ///< relative change of the cost
  double seconds = 0.0;          ///< since the descent began
};

/// Function to minimise, and the tolerances.
struct DescentOptions {
  /// Residuals at a point of the unit box; none if it cannot be evaluated. The Jacobian is computed
  /// only on request.
  std::function<std::optional<Linearisation>(std::span<const double> z, bool jacobian)> linearise;
  double trust_radius = 0.0;  ///< radius of the first step: 1 / damping of Levenberg and Marquardt
  int most_iterations = 0;
  double function_tolerance = kFunctionTolerance;
  double parameter_tolerance = 1e-9;
  /// Called after every iteration, with the start as number 0; returns true to end the descent. May
  /// be empty.
  std::function<bool(const DescentStep&)> enough;
};

/// End of a descent.
struct Descent {
  bool converged = false;  ///< within the tolerances
  int iterations = 0;      ///< steps tried, the start not counted
  std::string failure;     ///< why the descent gave up; else empty
};

}  // namespace rigcal::calib
