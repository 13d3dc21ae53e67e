#pragma once

#include <vector>

#include "calib/search/evaluator.hpp"

namespace rigcal::calib {

/// Lengths of the horizons, each a few times the one before it: from a few of the shortest sample
/// intervals up to the longest first period.
std::vector<double> horizons_s(const Problem& problem);

/// Result of the growing horizon of a start.
struct GrowingHorizon {
  int iterations = 0;                     ///< that they took
  std::vector<std::vector<double>> ends;  ///< where each of them led, the longest last
};

/// Fits the first part of each record at coarse fidelity, then longer and longer parts. An
/// oscillation is fitted before it completes a cycle, so that phase errors cannot alias: fitted at
/// once, a frequency that is off by more than a cycle in the record leads into a valley of slow
/// valves and stiff oil. Nor are later periods, which repeat the first, worth their time yet.
///
/// Leaves the evaluator at Fidelity::coarse with the end point as its best, evaluated over whole
/// records. Where the fit is stopped, fidelity and best point are those it was stopped at.
///
/// @param z           in: a point that can be simulated; out: where to go on from; the same point
///                    where whole records contradict what was found
/// @param iterations  budget of the whole start; horizons take half of it at most
GrowingHorizon by_growing_horizon(const Problem& problem, Evaluator& evaluator,
                                  std::vector<double>& z, int iterations, int start,
                                  const FitOptions& options);

}  // namespace rigcal::calib
