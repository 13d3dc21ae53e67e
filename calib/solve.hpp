#pragma once

#include <vector>

#include "calib/result/fit_result.hpp"
#include "calib/search/evaluator.hpp"
#include "calib/search/fit_options.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// Data that later steps need of a solved fit; the optimum is not ok if there is none.
struct Solved {
  Evaluation optimum;
  Uncertainty spread;
  std::vector<std::size_t> open;  ///< unknowns that a scaling symmetry leaves open
};

/// Solves a problem and describes the result except for the scores: multi-start, weights,
/// verification, intervals.
Solved solve_problem(Problem& problem, Evaluator& evaluator, const FitOptions& options, Fit& fit);

/// The same. If its only start ends away from a minimum, it continues with further starts, as a
/// multi-start that began with it would.
Solved solve_from_starts(Problem& problem, Evaluator& evaluator, const FitOptions& options,
                         Fit& fit);

}  // namespace rigcal::calib
