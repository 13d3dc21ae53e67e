#pragma once

#include <vector>

#include "calib/result/fit_result.hpp"
#include "calib/search/evaluator.hpp"
#include "calib/search/fit_options.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// What every later look at a fit needs; the optimum is not ok where there is none.
struct Solved {
  Evaluation optimum;
  Uncertainty spread;
  std::vector<std::size_t> open;  ///< unknowns that a scaling symmetry leaves open
};

/// Solves a problem and describes what was found, all but the scores: multi-start, weights, verify,
/// trust.
Solved solve_problem(Problem& problem, Evaluator& evaluator, const FitOptions& options, Fit& fit);

/// The same; where its only start ends at no minimum, goes on with further starts as a multi-start
/// would that had begun with that one.
Solved solve_from_starts(Problem& problem, Evaluator& evaluator, const FitOptions& options,
                         Fit& fit);

}  // namespace rigcal::calib
