#pragma once

#include <vector>

#include "calib/result/fit_result.hpp"
#include "calib/search/evaluator.hpp"
#include "calib/search/fit_options.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// Results of a solved fit that later steps need. If the fit found no optimum, `optimum` is not ok.
struct Solved {
  Evaluation optimum;
  Uncertainty uncertainty;
  std::vector<std::size_t> open;  ///< unknowns that a scaling symmetry leaves undetermined
};

/// Solves a problem: runs the multi-start, estimates weights, verifies the optimum and computes
/// intervals. Describes everything except the scores in `fit`.
Solved solve_problem(Problem& problem, Evaluator& evaluator, const FitOptions& options, Fit& fit);

/// Calls solve_problem(). If its only start ends away from a minimum, continues with further
/// starts. The result is the same as if the fit had been a multi-start from the beginning.
Solved solve_from_starts(Problem& problem, Evaluator& evaluator, const FitOptions& options,
                         Fit& fit);

}  // namespace rigcal::calib
