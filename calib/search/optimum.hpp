#pragma once

#include <span>
#include <string>
#include <vector>

#include "calib/problem/evaluation.hpp"

namespace rigcal::calib {

enum class BoundSide { inside, lower, upper };

/// A parameter counts as being at its bound if it is within this distance of a face of the unit
/// box.
inline constexpr double kAtBound = 1e-6;

BoundSide bound_side(double z);

/// Returns the relative size below which a singular value of the column-scaled Jacobian belongs to
/// a direction that the data do not determine. It equals the accuracy of the derivatives
/// (ErrorNorm).
double rank_threshold(double simulation_tolerance);

/// A point is a minimum if one more step would lower the cost by less than this many variances of a
/// residual. A single parameter is then off by at most 0.14 standard errors.
inline constexpr double kMinimumLeaves = 0.01;

/// Returns the unknowns that are at a bound and for which the cost would fall beyond the bound, but
/// not inside it.
std::vector<bool> active_bounds(const Linearisation& system, std::span<const double> z);

/// Checks whether a point is a minimum in the box, independently of the optimiser's own criteria.
struct OptimumCheck {
  std::vector<BoundSide> side;     ///< one per unknown
  std::vector<bool> active_bound;  ///< returned by active_bounds()
  Eigen::VectorXd step;            ///< Gauss-Newton step in the unit box; 0 at an active bound
  /// Root mean square length of the Gauss-Newton step over the free directions, in standard errors
  /// (the relative offset of Bates and Watts, Technometrics 23, 1981). At 0.01 the remaining step
  /// is a hundredth of the uncertainty due to noise.
  double relative_offset = 0.0;
  /// Fraction of the cost that this step would remove according to the linear model.
  double reducible = 0.0;
  /// The same predicted reduction, in variances of a residual. A value of 2 corresponds to one
  /// parameter at the end of its 95 % interval.
  double fall_left = 0.0;
  /// Returns true if a search may end: the relative offset is below 0.01 and the point is a
  /// minimum.
  bool stationary() const;
  /// Returns true if the search has converged: the predicted reduction is at most kMinimumLeaves.
  bool is_minimum() const;
};

OptimumCheck check_optimum(const Problem& problem, const Evaluation& evaluation);

/// Explains, as the end of a sentence, why a search ended away from a minimum: how much further the
/// cost would fall, which parameters form the valley that the remaining step follows, at which
/// bounds the cost still falls outwards, and what would help. Empty at a minimum.
std::string far_from_minimum(const Problem& problem, const Evaluation& evaluation,
                             const OptimumCheck& check);

}  // namespace rigcal::calib
