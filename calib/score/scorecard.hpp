#pragma once

#include <span>
#include <string>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/estimate_covariance.hpp"
#include "calib/result/fit_result.hpp"

namespace rigcal::calib {

/// Simulates every condition of a problem at z, over the whole record, and scores it.
///
/// @param z        shape (unknowns), in the unit box
/// @param effects  effects considered in the fit; those of the sensors add to the uncertainty of
///                 the scores
/// @return         one score per condition, in order; it contains the reason if the condition
///                 cannot be simulated, or if the problem's flag ended the job before
std::vector<ConditionScore> score_conditions(const Problem& problem, std::span<const double> z,
                                             int threads, const EffectCovariance& effects = {});

/// Repeats the residual tests of predictions without the component that the uncertainty of the
/// estimates explains (ConditionScore::explained). Even if the model is correct, inexact estimates
/// leave structure in the residual, which is not a model error.
///
/// The test for lack of fit of a record from another day is repeated in the same way. What differs
/// between the days, with stated or usual sizes, is not a model error. The whole residual counts on
/// a day of the fit, and if the component is larger than these sizes let expect.
///
/// @param dates   dates of the fitted records; empty if not all are known
/// @param scores  one per condition of the problem, in order
void test_predictions(const Problem& problem, const std::vector<std::string>& dates,
                      std::vector<ConditionScore>& scores);

/// Returns entries without scores for the conditions of a problem. Used for validation conditions
/// whose nuisance parameters could not be estimated.
///
/// @param why  the reason, in words
std::vector<ConditionScore> unscored_conditions(const Problem& problem, const std::string& why);

/// Warns about scores that are better than the noise allows for any model. Either the fit follows
/// the noise, or the noise is smaller than its stated standard deviation.
std::vector<std::string> overfitting_warnings(const std::vector<ConditionScore>& scores);

}  // namespace rigcal::calib
