#pragma once

#include <Eigen/Core>
#include <atomic>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/posterior.hpp"

namespace rigcal::calib {

/// How many of some points of the unit box keep each limit of the problem's conditions. What cannot
/// be simulated keeps none.
///
/// @param points  unit-box coordinates
/// @param cancel  ends it; then the result is empty
std::vector<KeptLimit> kept_limits(const Problem& problem,
                                   const std::vector<std::vector<double>>& points, int threads,
                                   const std::atomic<bool>* cancel);

}  // namespace rigcal::calib
