#pragma once

#include <vector>

#include "calib/result/fit_result.hpp"
#include "calib/search/evaluator.hpp"
#include "calib/search/fit_options.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// Results of a solved fit that later steps need. The optimum is not ok if there is none.
struct Solved {
  Evaluation optimum;
  Uncertainty spread;
  std::vector<std::size_t> open;  ///< unknowns that a scaling symmetry leaves undetermined
};

/// Solves a problem and describes the result except for the scores: multi-start, weights,
/// verification, intervals.
Solved solve_problem(Problem& problem, Evaluator& evaluator, const FitOptions& options, Fit& fit);

/// Does what solve_problem() does, and if its only start ends away from a minimum, continues with
/// further starts, just as a multi-start that began with that start would.
Solved solve_from_starts(Problem& problem, Evaluator& evaluator, const FitOptions& options,
                         Fit& fit);

}  // namespace rigcal::calib
