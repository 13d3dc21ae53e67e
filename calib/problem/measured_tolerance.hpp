#pragma once

#include <atomic>
#include <span>

#include "calib/problem/problem.hpp"

namespace rigcal::calib {

/// Measures for each condition with a recorded drive at which tolerance the errors of its
/// simulation are harmless (docs/decisions/0047). The rule of Problem::tolerance_of() takes an
/// error of the tolerance that is the same throughout. What a recorded drive excites is simulated
/// anew from sample to sample, and its errors may be a thousandth of that. Where
/// only nuisance parameters are unknown, too few simulations follow to be worth it.
///
/// @param z  where, in the unit box
void measure_tolerances(Problem& problem, std::span<const double> z, int threads,
                        const std::atomic<bool>* cancel);

/// Measures again at another point, and takes the measured tolerances that must be much finer
/// there. None becomes coarser: each change is another cost, which has its minimum elsewhere.
///
/// @return  whether any was changed
bool refine_tolerances(Problem& problem, std::span<const double> z, int threads,
                       const std::atomic<bool>* cancel);

}  // namespace rigcal::calib
