#pragma once

#include <vector>

#include "calib/search/evaluator.hpp"
#include "calib/search/iterations.hpp"

namespace rigcal::calib {

/// Result of multiple shooting.
struct ShootingResult {
  std::vector<double> z;  ///< in the unit box; the start point if the method failed
  int iterations = 0;     ///< number of iterations used
  /// Largest remaining jump between two pieces, in units of the absolute tolerances of the states
  /// (1e-6 m, 1e-5 m/s, 100 Pa, 1e-3 V); infinite if the method failed.
  double largest_gap = 0.0;
};

/// Finds a start for the fit by multiple shooting (H. G. Bock, Recent advances in parameter
/// identification techniques for O.D.E., in Numerical Treatment of Inverse Problems, 1983). Every
/// record is cut into pieces, each simulated from its own initial state. These states are unknowns
/// in addition to the parameters. They start from the recorded values, so that no piece can drift
/// far from the record, whatever the parameter values. The residuals are those of the samples and
/// the jumps between the end of a piece and the initial state of the next. The weight of the jumps
/// increases from stage to stage until the pieces form one continuous run.
///
/// Each jump links only two neighbouring states, so every second state can be eliminated by a Schur
/// complement (docs/decisions/0010). The result is only a start point: Search determines the status
/// and the values of the fit from whole records.
///
/// @param z           start point, in the unit box
/// @param interval_s  length of a piece
/// @param most        maximum number of iterations over all stages
/// @throws InputError  if an interval has fewer than four samples, or the controller has a
///                     `sample_time`
ShootingResult multiple_shooting(const Problem& problem, Evaluator& evaluator,
                                 std::vector<double> z, double interval_s, int most,
                                 Iterations& iterations);

}  // namespace rigcal::calib
