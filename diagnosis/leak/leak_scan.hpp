#pragma once

#include <atomic>

#include "calib/problem/problem.hpp"

namespace rigcal::diagnosis {

/// Range of the search for the leak of a record.
struct LeakScan {
  double best_coefficient = 0.0;     ///< simulated coefficient with the least cost
  double largest_coefficient = 0.0;  ///< largest simulated one
};

/// Simulates a record without a leak and over a geometric range of coefficients, until the share
/// passes `share_above` and a larger leak fits worse, or no more flow can leak.
///
/// @param condition    whose unknowns keep their start values
/// @param cancel       ends the simulations when it becomes true; may be null
/// @throws NoResultError  a run fails, is cancelled, moves no oil, or has a single sample in its
///                        windows
LeakScan scan_leaks(const calib::Problem& problem, const calib::ProblemCondition& condition,
                    double share_above, const std::atomic<bool>* cancel = nullptr);

}  // namespace rigcal::diagnosis
