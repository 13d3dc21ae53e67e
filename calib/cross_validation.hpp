#pragma once

#include <string>
#include <vector>

#include "calib/fit.hpp"
#include "calib/search/budget.hpp"

namespace rigcal::calib {

/// Leaves out one `fit` condition at a time, fits the others starting from the values of `whole`,
/// and predicts the omitted one (its own nuisance parameters are estimated on it). A condition
/// cannot be predicted if it alone determines an unknown, for example because no other condition
/// has its leak level.
///
/// @param whole  the fit of all conditions, with its scores
/// @param left   what remains of the budget of the whole job
std::vector<HeldOut> cross_validate(const datasets::Campaign& campaign,
                                    const std::vector<datasets::Record>& records, const Fit& whole,
                                    const FitOptions& options, Budget& left);

/// Returns a sentence with the number of predicted conditions and the worst prediction.
std::string cross_validation_summary(const std::vector<HeldOut>& held_out);

/// Describes the main findings: the condition whose prediction is worst relative to its fit, and
/// the parameter that changes most.
std::vector<std::string> cross_validation_words(const std::vector<HeldOut>& held_out);

}  // namespace rigcal::calib
