#pragma once

#include <span>
#include <string>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/fitted_parameter.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// Names combinations that the data determine where single parameters are undetermined. For each
/// positive parameter that is weak or not identifiable it is the product of powers with the partner
/// that it moves along with. The exponent q of a ~ b^q comes from the covariance of the logarithms,
/// and is rounded to 1/2, 1 or 2 within a tenth. Adds the same words to the reasons of
/// `parameters`.
///
/// @param parameters  result of describe_unknowns()
/// @return            "the records fix mass/damping = 0.085 s (to 1.2 %), not mass and damping"
std::vector<std::string> name_combinations(const Problem& problem, std::span<const double> z,
                                           const Uncertainty& found,
                                           std::vector<FittedParameter>& parameters);

}  // namespace rigcal::calib
