#pragma once

#include <atomic>
#include <span>

#include "calib/problem/problem.hpp"

namespace rigcal::calib {

/// Determines, for each condition with a recorded drive, the tolerance at which simulation errors
/// are harmless (docs/decisions/0047). The rule in Problem::tolerance_of() assumes that the error
/// is as large as the tolerance and the same at all samples. With a recorded drive the error
/// changes from sample to sample, and may be a thousandth of that. If only nuisance parameters are
/// unknown, nothing is measured, because too few simulations follow to repay the effort.
///
/// @param z  point in the unit box at which to measure
void measure_tolerances(Problem& problem, std::span<const double> z, int threads,
                        const std::atomic<bool>* cancel);

/// Measures again at another point, and adopts those tolerances that must be much finer there. No
/// tolerance becomes coarser, because each change alters the cost and thereby moves its minimum.
///
/// @return  true if any tolerance was changed
bool refine_tolerances(Problem& problem, std::span<const double> z, int threads,
                       const std::atomic<bool>* cancel);

/// Returns an upper limit for the norm of the simulation errors of all residuals at the working
/// tolerances, each divided by its standard deviation. An estimate is off by at most this many of
/// its standard errors for white noise. A measured tolerance may be too coarse by the factor that
/// refine_tolerances() leaves. Elsewhere the error of a sample is at most the tolerance times the
/// range of the signal.
double largest_simulation_error(const Problem& problem);

}  // namespace rigcal::calib
