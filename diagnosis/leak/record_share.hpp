#pragma once

#include <cstddef>

#include "calib/problem/problem.hpp"
#include "diagnosis/leak/steady_leak.hpp"

namespace rigcal::diagnosis {

/// Samples of a record that stand for its steady state: the last whole periods of a sine or square,
/// the first being left out as transient where there are three or more; else all that count.
struct SteadyPart {
  std::size_t first = 0;
  std::size_t count = 0;
};

/// @throws NoResultError  a single sample counts
SteadyPart steady_part(const calib::ProblemCondition& condition);

/// What leaks in a simulated record, over its steady part; slopes where the run has sensitivities.
///
/// @param run    of the condition, at the times of its record
/// @param servo  column of the servo flow among its outputs; the next is the leakage flow
/// @throws NoResultError  the run moves no oil, or a single sample counts
SteadyLeak leak_in_record(const calib::ProblemCondition& condition, const model::Simulation& run,
                          Eigen::Index servo);

}  // namespace rigcal::diagnosis
