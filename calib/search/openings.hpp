#pragma once

#include <vector>

#include "calib/search/evaluator.hpp"

namespace rigcal::calib {

/// Lengths of openings, each a few times the one before it: from a few of the shortest sample
/// intervals up to the longest first period.
std::vector<double> opening_lengths_s(const Problem& problem);

/// What the openings of a start came to.
struct Openings {
  int iterations = 0;                     ///< that they took
  std::vector<std::vector<double>> ends;  ///< where each of them led, the longest last
};

/// Solves with coarse simulations of longer and longer openings of the records. What rings is
/// fitted while it has not yet rung once: where all of it is fitted at once, a frequency that is
/// off by more than a cycle in the record leads into a valley of slow valves and stiff oil. What
/// later samples repeat is not worth its time yet either.
///
/// Leaves the evaluator at Effort::coarse, its best point where it ended, all samples looked at.
/// Where the fit is stopped its effort and best point are those that it has come to.
///
/// @param z           in: a point that can be simulated; out: where to go on from, the same point
///                    where all samples together speak against what was found
/// @param iterations  budget of the whole start; openings take half of it at most
Openings by_openings(const Problem& problem, Evaluator& evaluator, std::vector<double>& z,
                     int iterations, int start, const FitOptions& options);

}  // namespace rigcal::calib
