#pragma once

#include <Eigen/Core>
#include <atomic>
#include <span>

#include "calib/problem/problem.hpp"

namespace rigcal::diagnosis {

/// How long and how finely a periodic state was simulated. Zeros: as PeriodicOptions.
struct PeriodicEffort {
  int periods = 0;
  int intervals = 0;  ///< per piece of a period
};

/// Leak in one condition for one leakage coefficient, with its derivatives.
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
  Eigen::VectorXd share_slope;      ///< d share / d parameter, SI, shape (free)
  Eigen::VectorXd flow_slope;       ///< d leakage flow / d parameter
  bool is_periodic = false;         ///< true for the periodic state, false for the record
  PeriodicEffort effort;            ///< work needed to reach the periodic state
};

/// Computes the leak in one condition. The leak share is defined only here. For a generated sine or
/// square with all other inputs constant, the share is that of the periodic state, from the same
/// simulation as in a leak table (periodic_flow), even if a record has only few periods.
/// With recorded inputs, or if the rig does not become periodic, there is no periodic state, and
/// the flows are averaged over the record (record_share.hpp).
///
/// @param values  SI; includes the leakage coefficient, which must be above 0 if slopes are
///                requested
/// @param free    table indices of the parameters for which slopes are computed
/// @param least   effort to begin with, such as that of a similar leak
/// @throws NoResultError  if the run fails, moves no oil, or has only one sample in the windows
SteadyLeak steady_leak(const calib::Problem& problem, const calib::ProblemCondition& condition,
                       const model::ParameterValues& values, std::span<const int> free,
                       const std::atomic<bool>* cancel = nullptr, PeriodicEffort least = {});

/// Returns true if the drive of the condition is a sine or square of known frequency.
bool is_generated_wave(const datasets::Condition& condition);

/// Returns true if a generated wave is the only input that varies, so that there is a periodic
/// state.
bool has_periodic_state(const calib::ProblemCondition& condition);

}  // namespace rigcal::diagnosis
