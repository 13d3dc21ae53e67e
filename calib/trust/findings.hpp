#pragma once

#include <vector>

#include "calib/result/fit_result.hpp"
#include "calib/search/optimum.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// Completes a fit that already has its starts and counters. Adds parameters with intervals,
/// agreement of the starts, combinations and remedies, tests of the residuals, correlation, and
/// warnings about unreliable results.
///
/// @return  unknowns that a scaling symmetry leaves undetermined
std::vector<std::size_t> describe_findings(const Problem& problem, const Evaluation& optimum,
                                           const OptimumCheck& check, const Uncertainty& spread,
                                           int threads, Fit& fit);

}  // namespace rigcal::calib
