#pragma once

#include <cstddef>

#include "calib/problem/problem.hpp"
#include "diagnosis/record/steady_leak.hpp"

namespace rigcal::diagnosis {

/// Samples of a record that represent its steady state. For a sine or square these are the last
/// whole periods, without the first of them if there are three or more; otherwise all samples in
/// the windows.
struct SteadyPart {
  std::size_t first = 0;
  std::size_t count = 0;
};

/// @throws NoResultError  if fewer than two samples count
SteadyPart steady_part(const calib::ProblemCondition& condition);

/// Computes the leak in a simulated record over its steady part, with slopes if the run has
/// sensitivities.
///
/// @param run    simulation of the condition, at the times of its record
/// @param servo  column of the servo flow in the outputs; the next column is the leakage flow
/// @throws NoResultError  if the run moves no oil, or has only one sample in the windows
SteadyLeak leak_in_record(const calib::ProblemCondition& condition, const model::Simulation& run,
                          Eigen::Index servo);

}  // namespace rigcal::diagnosis
