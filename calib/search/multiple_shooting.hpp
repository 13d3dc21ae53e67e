#pragma once

#include <vector>

#include "calib/search/evaluator.hpp"
#include "calib/search/iterations.hpp"

namespace rigcal::calib {

/// End of multiple shooting.
struct ShootingResult {
  std::vector<double> z;  ///< in the unit box; the start if it failed
  int iterations = 0;     ///< iterations used
  /// Largest remaining jump between two pieces, in floors of the states' error control (1e-6 m,
  /// 1e-5 m/s, 100 Pa, 1e-3 V); infinite if it failed.
  double largest_gap = 0.0;
};

/// A start for the fit by multiple shooting (H. G. Bock, Recent advances in parameter
/// identification techniques for O.D.E., in Numerical Treatment of Inverse Problems, 1983): every
/// record is cut into pieces that are simulated each from a state of its own. These states are
/// unknowns beside the parameters; they start where the record says, so that no piece strays far,
/// whatever the parameters are. Residuals: those of the samples, and the jumps between the end of a
/// piece and the state of the next, whose weight grows from stage to stage until the pieces are one
/// run.
///
/// A jump joins two neighbours alone, so that every other state is eliminated by a Schur complement
/// (docs/decisions/0010). The result is a start: status and values of a fit come from Search on
/// whole records.
///
/// @param z           where it starts, in the unit box
/// @param interval_s  length of a piece
/// @param most        iterations of all stages together
/// @throws InputError  an interval of fewer than four samples; a controller with `sample_time`
ShootingResult multiple_shooting(const Problem& problem, Evaluator& evaluator,
                                 std::vector<double> z, double interval_s, int most,
                                 Iterations& iterations);

}  // namespace rigcal::calib
