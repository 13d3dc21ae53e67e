#pragma once

#include <Eigen/Core>
#include <atomic>
#include <span>

#include "calib/problem/problem.hpp"

namespace rigcal::diagnosis {

/// Leak in one condition at one leakage coefficient, with its derivatives.
struct SteadyLeak {
  /// @param servo, leak  mean absolute flows [m3/s], with their slopes
  SteadyLeak(double servo, double leak, const Eigen::VectorXd& servo_slope,
             const Eigen::VectorXd& leak_slope)
      : share(leak / servo),
        leak_flow_m3_per_s(leak),
        share_slope((leak_slope - share * servo_slope) / servo),
        flow_slope(leak_slope) {}

  double share = 0.0;               ///< mean |leakage flow| / mean |servo flow|
  double leak_flow_m3_per_s = 0.0;  ///< mean |leakage flow|
  Eigen::VectorXd share_slope;      ///< d share / d parameter, shape (free), SI
  Eigen::VectorXd flow_slope;       ///< d leakage flow / d parameter
  bool is_periodic = false;         ///< whether it is for the periodic state, not the record
};

/// Computes the leak in one condition. This is the only definition of its share. For a generated
/// sine or square with all other inputs constant, the share is that of the periodic state, from the
/// same simulation as in a leak table (calib::periodic_flow), however few periods a record has.
/// With recorded inputs, or if the rig does not become periodic, there is no periodic state, and
/// the flows are averaged over the record (record_share.hpp).
///
/// @param values  SI, including the leakage coefficient, which must be above 0 for slopes
/// @param free    table indices for the slopes
/// @throws NoResultError  if the run fails, moves no oil, or has only one sample in the windows
SteadyLeak steady_leak(const calib::Problem& problem, const calib::ProblemCondition& condition,
                       const model::ParameterValues& values, std::span<const int> free,
                       const std::atomic<bool>* cancel = nullptr);

/// Whether the condition is a sine or square of known frequency.
bool is_generated_wave(const datasets::Condition& condition);

}  // namespace rigcal::diagnosis
