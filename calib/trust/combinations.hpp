#pragma once

#include <span>
#include <string>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/fitted_parameter.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// Names combinations that the data determine although they do not determine the individual
/// parameters. For each positive parameter that is weak or not identifiable, the combination is a
/// product of powers of this parameter and the one that it is most closely tied to. The exponent q
/// in a ~ b^q follows from the covariance of the logarithms, and is rounded to 1/2, 1 or 2 if it is
/// within a tenth of that value. The same words are added to the reasons in `parameters`.
///
/// @param parameters  result of describe_unknowns()
/// @return            for example, "the records fix mass/damping = 0.085 s (to 1.2 %), not mass and
///                    damping"
std::vector<std::string> name_combinations(const Problem& problem, std::span<const double> z,
                                           const Uncertainty& found,
                                           std::vector<FittedParameter>& parameters);

}  // namespace rigcal::calib
