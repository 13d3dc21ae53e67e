#pragma once

#include <string>
#include <vector>

#include "calib/result/fitted_parameter.hpp"
#include "calib/result/search_report.hpp"

namespace rigcal::calib {

/// Whether two costs belong to the same minimum: they differ by at most 0.02 variances of the
/// residuals (0.2 standard errors), or by two millionths, the error of the simulations.
bool same_cost(double a, double b, double variance);

/// Whether start a is better: it has the lower cost, whatever ended it. At equal cost a converged
/// start is better than one that has not converged.
bool better_start(const StartReport& a, const StartReport& b, double variance);

/// Gathers converged starts that ended at one point: no parameter farther than a tenth of its
/// interval from that of the basin's best, parameters without an interval left out, and the cost
/// the same. Ordered by cost, then by start.
///
/// @param parameters  of the fit, in the order of the starts' values
/// @param variance    of the weighted residuals: 1, or more where the model leaves more than noise
std::vector<Basin> basins(const std::vector<StartReport>& starts,
                          const std::vector<FittedParameter>& parameters, double variance);

/// "41 of 64 starts ended at the best point; ...": how far the starts agree, in words.
std::string agreement_of(const std::vector<StartReport>& starts, const std::vector<Basin>& basins,
                         double variance);

}  // namespace rigcal::calib
