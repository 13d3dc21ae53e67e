#pragma once

#include <string>
#include <vector>

#include "calib/fit.hpp"

namespace rigcal::calib {

/// Gathers converged starts that ended at one point: no parameter farther than a tenth of its
/// interval from that of the basin's best, parameters without an interval left out, and the cost
/// higher by no more than 0.02 (0.2 standard errors). Ordered by cost, then by start.
///
/// @param parameters  of the fit, in the order of the starts' values
std::vector<Basin> basins(const std::vector<StartReport>& starts,
                          const std::vector<FittedParameter>& parameters);

/// "41 of 64 starts ended at the best point; ...": how far the starts agree, in words.
std::string agreement_of(const std::vector<StartReport>& starts, const std::vector<Basin>& basins,
                         double cost_scale);

}  // namespace rigcal::calib
