#pragma once

#include <span>
#include <string>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/fitted_parameter.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// What is fixed where single parameters are not: for each positive parameter that is weak or not
/// identifiable, the product of powers with the partner it moves along with that the data do fix.
/// Of the law a ~ b^q that the covariance of the logarithms tells, q is rounded to 1/2, 1 or 2
/// where it is within a tenth of it. Adds the same words to the reasons of `parameters`.
///
/// @param parameters  of describe_unknowns()
/// @return            "the records fix mass/damping = 0.085 s (to 1.2 %), not mass and damping"
std::vector<std::string> name_combinations(const Problem& problem, std::span<const double> z,
                                           const Uncertainty& found,
                                           std::vector<FittedParameter>& parameters);

}  // namespace rigcal::calib
