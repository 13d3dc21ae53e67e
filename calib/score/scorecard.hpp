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
/// @param effects  effects considered in the fit; sensor effects count in the scores' uncertainty
/// @return         one score per condition, in order; a condition that cannot be simulated says why
std::vector<ConditionScore> score_conditions(const Problem& problem, std::span<const double> z,
                                             int threads, const EffectSpread& effects = {});

/// Repeats the residual tests of predictions without the component that the uncertainty of the
/// estimates explains (ChannelScore::explained). Even in a correct model, an inexact estimate
/// leaves structure in the residual, and this is not a model error.
///
/// @param scores  one per condition of the problem, in order
void test_predictions(const Problem& problem, std::vector<ConditionScore>& scores);

/// Returns the conditions of a problem without scores, for validation conditions whose nuisance
/// parameters were not estimated.
///
/// @param why  in words
std::vector<ConditionScore> unscored_conditions(const Problem& problem, const std::string& why);

/// Warns of scores that are better than the noise allows any model. Then the fit follows the noise,
/// or the noise is smaller than its stated standard deviation.
std::vector<std::string> overfitting_warnings(const std::vector<ConditionScore>& scores);

}  // namespace rigcal::calib
