#pragma once

#include <functional>
#include <vector>

namespace rigcal::diagnosis {

/// A simulated leak for one coefficient, with its derivatives with respect to the coefficient.
struct LeakPoint {
  double coefficient = 0.0;
  double share = 0.0;               ///< leak share, see steady_leak()
  double leak_flow_m3_per_s = 0.0;  ///< mean |leakage flow|
  double share_slope = 0.0;
  double flow_slope = 0.0;
};

/// Simulates the leak for a coefficient above 0.
using LeakAt = std::function<LeakPoint(double coefficient)>;

/// Interpolates leak share and flow between simulated coefficients, which cover the plausible range
/// for one record. Between two points the curve is a cubic Hermite polynomial with the simulated
/// values and slopes; beyond the last point it is a straight line.
class LeakCurve {
 public:
  /// @param points  at least 2, with increasing coefficients >= 0
  /// @throws std::invalid_argument  if there are fewer than 2 points, if a coefficient is negative,
  ///                                or if the coefficients do not increase
  explicit LeakCurve(std::vector<LeakPoint> points);

  /// Returns 0 if the coefficient is not positive.
  double share(double coefficient) const;
  double leak_flow_m3_per_s(double coefficient) const;
  double share_slope(double coefficient) const;
  const std::vector<LeakPoint>& points() const { return points_; }

 private:
  std::vector<LeakPoint> points_;
};

/// Builds the curve around an estimate. The leak is simulated at the estimate itself, so that the
/// share is exact there, and at both ends of the range of the coefficient. If the range includes 0,
/// the curve begins at 0, without a leak.
///
/// @param reach  half-width of the interval of interest, above 0
LeakCurve curve_about(const LeakAt& leak_at, double coefficient, double reach);

/// Returns the point of curve_about() at the coefficient itself. The leak is simulated there only,
/// unless the coefficient is so close to 0 that the curve has no point of its own there.
///
/// @param coefficient  above 0
LeakPoint point_about(const LeakAt& leak_at, double coefficient, double reach);

}  // namespace rigcal::diagnosis
