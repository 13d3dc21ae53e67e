#pragma once

#include <vector>

#include "calib/result/fit_result.hpp"
#include "calib/search/optimum.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// What the search has found, into a fit that has its starts and counters: parameters with
/// intervals, how far starts agree, what identifies them and what would, tests of the residuals,
/// correlation, and warnings of what is not to be trusted.
///
/// @return  unknowns that a scaling symmetry leaves open
std::vector<std::size_t> describe_findings(const Problem& problem, const Evaluation& optimum,
                                           const OptimumCheck& check, const Uncertainty& spread,
                                           int threads, Fit& fit);

}  // namespace rigcal::calib
