#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "calib/problem/problem.hpp"

namespace rigcal::diagnosis {

/// What leaks in one condition at one leakage coefficient, and its derivatives.
struct SteadyLeak {
  double share = 0.0;               ///< mean |leakage flow| / mean |servo flow|
  double leak_flow_m3_per_s = 0.0;  ///< mean |leakage flow|
  Eigen::VectorXd share_slope;      ///< d share / d parameter, shape (free), SI
  Eigen::VectorXd flow_slope;       ///< d leakage flow / d parameter
  bool is_periodic = false;         ///< of the periodic state, not of the record
};

/// The one definition of a share: of a generated sine or square whose other inputs are constant it
/// is that of the periodic state, from the same simulation as a leak table's
/// (calib::periodic_flow), however few periods a record has. Where a record brings inputs of its
/// own there is no periodic state, nor where the rig does not come to one; the flows are then
/// averaged over the samples of steady_part().
///
/// @param values  SI, the leakage coefficient included; above 0 where slopes are wanted
/// @param free    table indices of the slopes that are wanted
/// @throws NoResultError  the run fails, moves no oil, or has a single sample that counts
SteadyLeak steady_leak(const calib::Problem& problem, const calib::ProblemCondition& condition,
                       const model::ParameterValues& values, std::span<const int> free);

/// Samples of a record that stand for its steady state: the last whole periods of a sine or square,
/// the first being left out as transient where there are three or more; else all that count.
struct SteadyPart {
  std::size_t first = 0;
  std::size_t count = 0;
};
SteadyPart steady_part(const calib::ProblemCondition& condition);

}  // namespace rigcal::diagnosis
