#pragma once

#include <span>
#include <vector>

#include "calib/problem.hpp"

namespace rigcal::diagnosis {

/// Samples of a run over which flows are averaged: the last whole periods of a sine or square, the
/// first being left out as transient where there are three or more; else every sample that counts.
struct SteadyPart {
  std::size_t first = 0;
  std::size_t count = 0;
};
SteadyPart steady_part(const calib::ProblemCondition& condition);

/// One simulated leak.
struct LeakPoint {
  double coefficient = 0.0;
  double share = 0.0;               ///< mean |leakage flow| / mean |servo flow|
  double leak_flow_m3_per_s = 0.0;  ///< mean |leakage flow|
  double cost = 0.0;                ///< half the sum of squared weighted residuals of the record
};

/// A leak in one condition whose other parameters are known; unknowns keep their start values.
///
/// @throws NoResultError  the run fails, moves no oil, or has a single sample that counts
LeakPoint simulate_leak(const calib::Problem& problem, const calib::ProblemCondition& condition,
                        double coefficient);

/// What a leak does in one condition of a rig that is known otherwise.
class LeakCurve {
 public:
  /// @param points  by increasing coefficient, the first at 0, at least 4
  /// @throws std::invalid_argument  fewer, or not increasing
  explicit LeakCurve(std::vector<LeakPoint> points);

  /// Monotone cubic interpolation in the coefficient (Fritsch and Butland); linear beyond the last
  /// point; 0 where the coefficient is negative.
  double share(double coefficient) const;
  double leak_flow_m3_per_s(double coefficient) const;
  /// The coefficient of least cost among the points: where a fit starts.
  double best_coefficient() const;
  const std::vector<LeakPoint>& points() const { return points_; }

 private:
  double interpolate(double LeakPoint::*member, const std::vector<double>& slopes,
                     double coefficient) const;
  std::vector<LeakPoint> points_;
  std::vector<double> share_slopes_;
  std::vector<double> flow_slopes_;
};

/// Simulates a condition without a leak and over a geometric range of coefficients, until the
/// share passes `share_above` or no more flow can leak.
///
/// @param condition    whose unknowns keep their start values
/// @throws NoResultError  as simulate_leak()
LeakCurve leak_curve(const calib::Problem& problem, const calib::ProblemCondition& condition,
                     double share_above);

}  // namespace rigcal::diagnosis
