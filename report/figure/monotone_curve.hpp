#pragma once

#include <span>
#include <vector>

namespace rigcal::report {

struct DrawnCurve {
  std::vector<double> x, y;
};

/// Returns a smooth curve through points, for drawing. Between two points it is a cubic that stays
/// between their values, so that a few points show no extreme that was not computed (Fritsch and
/// Butland, SIAM Journal on Scientific and Statistical Computing 5, 1984).
///
/// @param x, y  shape (n), finite, x ascending; the points themselves are returned if n < 3 or two
///              x are equal
DrawnCurve monotone_curve(std::span<const double> x, std::span<const double> y);

}  // namespace rigcal::report
