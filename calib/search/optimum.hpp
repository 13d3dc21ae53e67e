#pragma once

#include <span>
#include <vector>

#include "calib/problem/evaluation.hpp"

namespace rigcal::calib {

enum class BoundSide { inside, lower, upper };

/// Distance from a face of the unit box within which a parameter is at its bound.
inline constexpr double kAtBound = 1e-6;

BoundSide bound_side(double z);

/// Relative size below which a singular value of the column-scaled Jacobian is that of a direction
/// which the data do not determine: the derivatives themselves are no better (ErrorNorm).
double rank_threshold(double simulation_tolerance);

/// A point is a minimum if one more step would lower the cost by less than this many variances of a
/// residual; a single parameter is then off by at most 0.14 standard errors.
inline constexpr double kMinimumLeaves = 0.01;

/// Unknowns at a bound where the cost falls only towards the outside.
std::vector<bool> active_bounds(const Linearisation& system, std::span<const double> z);

/// Whether a point is a minimum in the box, judged by our own measure and not by the optimiser's.
struct OptimumCheck {
  std::vector<BoundSide> side;     ///< per unknown
  std::vector<bool> active_bound;  ///< result of active_bounds()
  Eigen::VectorXd step;            ///< Gauss-Newton step in the unit box; 0 at an active bound
  /// Length of the Gauss-Newton step in standard errors, root mean square over the free directions
  /// (relative offset of Bates and Watts, Technometrics 23, 1981). At 0.01 the remaining step is a
  /// hundredth of the uncertainty from noise.
  double relative_offset = 0.0;
  double reducible = 0.0;  ///< fraction of the cost that this step is predicted to take away
  /// The same in variances of a residual; 2 corresponds to one parameter at the end of its 95 %
  /// interval.
  double fall_left = 0.0;
  /// Whether a search may end: a relative offset below 0.01, at a minimum.
  bool stationary() const;
  /// Whether the search has converged: at most kMinimumLeaves are left of the fall.
  bool is_minimum() const;
};

OptimumCheck check_optimum(const Problem& problem, const Evaluation& evaluation);

}  // namespace rigcal::calib
