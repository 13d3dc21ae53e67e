#pragma once

#include <vector>

#include "calib/result/fit_result.hpp"
#include "calib/search/optimum.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// Completes a fit whose starts and counters are already set. Adds the parameters with their
/// intervals, the agreement of the starts, undetermined combinations and their remedies, residual
/// tests, correlations, and warnings about unreliable results.
///
/// @return  unknowns that a scaling symmetry leaves undetermined
std::vector<std::size_t> describe_findings(const Problem& problem, const Evaluation& optimum,
                                           const OptimumCheck& check, const Uncertainty& errors,
                                           int threads, Fit& fit);

}  // namespace rigcal::calib
