#pragma once

#include <string>
#include <vector>

#include "calib/fit.hpp"
#include "calib/search/budget.hpp"

namespace rigcal::calib {

/// Leaves out one `fit` condition after the other, fits the rest from the values of `whole`, and
/// predicts the one left out (nuisance parameters of its own are estimated on it). A condition that
/// alone tells of an unknown, such as the only one of its leak level, cannot be predicted.
///
/// @param whole   the fit with all of them, with its scores
/// @param budget  what is left of that of the whole job; null: no limit but `options.cancel`
std::vector<HeldOut> cross_validate(const datasets::Campaign& campaign,
                                    const std::vector<datasets::Record>& records, const Fit& whole,
                                    const FitOptions& options, Budget& left);

/// How many conditions were predicted, and how well at worst, in one sentence.
std::string cross_validation_summary(const std::vector<HeldOut>& held_out);

/// The most telling of it, in words: the condition that is predicted worst against its fit, and
/// the parameter that moves most.
std::vector<std::string> cross_validation_words(const std::vector<HeldOut>& held_out);

}  // namespace rigcal::calib
