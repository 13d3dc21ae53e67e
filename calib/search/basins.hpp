#pragma once

#include <string>
#include <vector>

#include "calib/result/fitted_parameter.hpp"
#include "calib/result/search_report.hpp"

namespace rigcal::calib {

/// Returns true if two costs belong to the same minimum, that is, if they differ by at most 0.02
/// variances of the residuals (0.2 standard errors), or by two millionths of the cost, the error of
/// the simulations.
bool same_cost(double a, double b, double variance);

/// Returns true if start a is better than start b, that is, if it has the lower cost, regardless of
/// why each start ended. At equal cost a converged start is better than one that has not converged.
bool better_start(const StartReport& a, const StartReport& b, double variance);

/// Groups converged starts that ended at the same point. Within a basin the costs are the same, and
/// each parameter is within a tenth of its interval from the best start of the basin. Parameters
/// without an interval are ignored. Basins are ordered by cost, then by start.
///
/// @param parameters  parameters of the fit, in the same order as the values in `starts`
/// @param variance    variance of the weighted residuals: 1, or more if the model leaves more than
///                    noise
std::vector<Basin> basins(const std::vector<StartReport>& starts,
                          const std::vector<FittedParameter>& parameters, double variance);

/// Describes, in words, how well the starts agree: "41 of 64 starts ended at the best point; ...".
std::string agreement_of(const std::vector<StartReport>& starts, const std::vector<Basin>& basins,
                         double variance);

}  // namespace rigcal::calib
