#pragma once

#include <span>
#include <string>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/estimate_spread.hpp"
#include "calib/result/fit_result.hpp"

namespace rigcal::calib {

/// Simulates every condition of a problem at z, over the whole record, and scores it.
///
/// @param z        shape (unknowns), in the unit box
/// @param effects  that the fit considered; those of sensors count in the uncertainty of the scores
/// @return         in the order of the problem's conditions; a condition that cannot be simulated
///                 says why
std::vector<ConditionScore> score_conditions(const Problem& problem, std::span<const double> z,
                                             int threads, const EffectSpread& effects = {});

/// Makes the residual tests of predictions again, without what the uncertainty of the estimates
/// explains (ChannelScore::explained): under the right model an estimate that is off leaves a
/// structure that is no error of the model.
///
/// @param scores  of the problem's conditions, in their order
void test_predictions(const Problem& problem, std::vector<ConditionScore>& scores);

/// The same conditions without scores, since their nuisance parameters were not estimated.
///
/// @param why  in words
std::vector<ConditionScore> unscored_conditions(const Problem& problem, const std::string& why);

/// Scores that are better than the noise allows any model, in words: the fit follows the noise, or
/// the noise is smaller than its stated standard deviation.
std::vector<std::string> overfitting_warnings(const std::vector<ConditionScore>& scores);

}  // namespace rigcal::calib
