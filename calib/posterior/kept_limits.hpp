#pragma once

#include <Eigen/Core>
#include <atomic>
#include <functional>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/posterior.hpp"

namespace rigcal::calib {

using ChangeOf = std::function<Eigen::VectorXd(std::size_t condition, std::size_t point)>;

/// Counts, for each limit of the problem's conditions, how many points keep it. A point that cannot
/// be simulated keeps no limit.
///
/// @param points  unit-box coordinates
/// @param change  returns by how much the effects of a point change the weighted outputs of a
///                condition, shape (channels * samples that count); may be empty
/// @param cancel  set to true to stop; the result is then empty
std::vector<KeptLimit> kept_limits(const Problem& problem,
                                   const std::vector<std::vector<double>>& points,
                                   const ChangeOf& change, int threads,
                                   const std::atomic<bool>* cancel);

}  // namespace rigcal::calib
