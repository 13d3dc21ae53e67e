#pragma once

#include <Eigen/Core>
#include <atomic>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/posterior.hpp"

namespace rigcal::calib {

/// Counts, for each limit of the problem's conditions, how many points keep it. A point that cannot
/// be simulated keeps no limit.
///
/// @param points  unit-box coordinates
/// @param cancel  set to true to stop; the result is then empty
std::vector<KeptLimit> kept_limits(const Problem& problem,
                                   const std::vector<std::vector<double>>& points, int threads,
                                   const std::atomic<bool>* cancel);

}  // namespace rigcal::calib
