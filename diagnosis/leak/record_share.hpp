#pragma once

#include <cstddef>

#include "calib/problem/problem.hpp"
#include "diagnosis/leak/steady_leak.hpp"

namespace rigcal::diagnosis {

/// Samples of a record that represent its steady state: the last whole periods of a sine or square,
/// without the first if there are three or more; else all samples in the windows.
struct SteadyPart {
  std::size_t first = 0;
  std::size_t count = 0;
};

/// @throws NoResultError  a single sample counts
SteadyPart steady_part(const calib::ProblemCondition& condition);

/// Leak in a simulated record, over its steady part; with slopes if the run has sensitivities.
///
/// @param run    of the condition, at the times of its record
/// @param servo  column of the servo flow among its outputs; the next is the leakage flow
/// @throws NoResultError  the run moves no oil, or has a single sample in the windows
SteadyLeak leak_in_record(const calib::ProblemCondition& condition, const model::Simulation& run,
                          Eigen::Index servo);

}  // namespace rigcal::diagnosis
