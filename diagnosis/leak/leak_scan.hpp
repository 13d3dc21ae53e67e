#pragma once

#include <atomic>

#include "calib/problem/problem.hpp"

namespace rigcal::diagnosis {

/// Range in which to search for the leak of a record.
struct LeakScan {
  double best_coefficient = 0.0;     ///< simulated coefficient with the lowest cost
  double largest_coefficient = 0.0;  ///< largest simulated coefficient
};

/// Simulates a record without a leak and with a geometric series of coefficients, until the share
/// exceeds `share_above` and a larger leak fits worse, or until no more flow can leak.
///
/// @param condition    its unknowns keep their start values
/// @param cancel       ends the simulations when it becomes true; may be null
/// @throws NoResultError  if a run fails, is cancelled, moves no oil, or has only one sample in its
///                        windows
LeakScan scan_leaks(const calib::Problem& problem, const calib::ProblemCondition& condition,
                    double share_above, const std::atomic<bool>* cancel = nullptr);

}  // namespace rigcal::diagnosis
