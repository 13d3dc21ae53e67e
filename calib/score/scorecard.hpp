#pragma once

#include <span>
#include <string>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/fit_result.hpp"

namespace rigcal::calib {

/// Simulates every condition of a problem at z, over the whole record, and scores it.
///
/// @param z  shape (unknowns), in the unit box
/// @return   in the order of the problem's conditions; a condition that cannot be simulated says
/// why
std::vector<ConditionScore> score_conditions(const Problem& problem, std::span<const double> z,
                                             int threads);

/// The same conditions without scores, since their nuisance parameters were not estimated.
///
/// @param why  in words
std::vector<ConditionScore> unscored_conditions(const Problem& problem, const std::string& why);

/// Scores that are better than the noise allows any model, in words: the fit follows the noise, or
/// the noise is smaller than its stated standard deviation.
std::vector<std::string> overfitting_warnings(const std::vector<ConditionScore>& scores);

}  // namespace rigcal::calib
