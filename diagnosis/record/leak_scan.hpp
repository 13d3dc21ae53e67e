#pragma once

#include <atomic>

#include "calib/problem/problem.hpp"

namespace rigcal::diagnosis {

/// Result of a scan: where to start the search for the leak in a record, and its range.
struct LeakScan {
  double best_coefficient = 0.0;     ///< simulated coefficient with the lowest cost
  double largest_coefficient = 0.0;  ///< largest simulated coefficient
};

/// Simulates a record without a leak and with a geometric series of coefficients, until the share
/// exceeds `share_above` and a larger leak fits worse, or until no more flow can leak.
///
/// @param condition    condition whose unknowns keep their start values
/// @param cancel       becomes true to end the simulations; may be null
/// @throws NoResultError  if a run fails, is cancelled, moves no oil, or has only one sample in its
///                        windows
LeakScan scan_leaks(const calib::Problem& problem, const calib::ProblemCondition& condition,
                    double share_above, const std::atomic<bool>* cancel = nullptr);

}  // namespace rigcal::diagnosis
