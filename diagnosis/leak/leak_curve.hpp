#pragma once

#include <functional>
#include <vector>

namespace rigcal::diagnosis {

/// Simulated leak at one coefficient, with its derivatives by the coefficient.
struct LeakPoint {
  double coefficient = 0.0;
  double share = 0.0;               ///< see steady_leak()
  double leak_flow_m3_per_s = 0.0;  ///< mean |leakage flow|
  double share_slope = 0.0;
  double flow_slope = 0.0;
};

/// Simulates a coefficient, which is above 0.
using LeakAt = std::function<LeakPoint(double coefficient)>;

/// Share and flow over the coefficient where one record may be: through simulated points, with the
/// simulated slope at each (cubic Hermite), straight on beyond the last.
class LeakCurve {
 public:
  /// @param points  by increasing coefficient, none negative, at least 2
  /// @throws std::invalid_argument  fewer, or not increasing
  explicit LeakCurve(std::vector<LeakPoint> points);

  /// 0 where the coefficient is not positive.
  double share(double coefficient) const;
  double leak_flow_m3_per_s(double coefficient) const;
  double share_slope(double coefficient) const;
  const std::vector<LeakPoint>& points() const { return points_; }

 private:
  std::vector<LeakPoint> points_;
};

/// The curve about an estimate. It is simulated at the estimate itself, so that its share is exact,
/// and at both ends of the range of the coefficient; from 0, without a leak, if that is in the
/// range.
///
/// @param reach  half the width of the interval of interest, above 0
LeakCurve curve_about(const LeakAt& leak_at, double coefficient, double reach);

}  // namespace rigcal::diagnosis
