#pragma once

#include <string>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/fit_result.hpp"
#include "calib/search/optimum.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// Which errors to believe, and why, in words: none where the fit ended at no minimum; how far
/// residuals are correlated, whether the model leaves more than noise.
std::string interval_advice(const Problem& problem, const OptimumCheck& check,
                            const Uncertainty& found, const std::vector<LackOfFit>& tests);

/// How the repeats differ from one another; empty where no condition has single repeats.
std::optional<BetweenRepeats> between_repeats(const Problem& problem, const Uncertainty& found);

/// That in words, with what it does to the intervals and what would help; empty where repeats
/// differ by no more than their noise.
std::string between_repeats_warning(const BetweenRepeats& repeats);

/// What the errors rest on where residuals hold no noise, in words.
std::string noiseless_warning(const Problem& problem, const Uncertainty& found);

/// Where bootstrap or profile say otherwise than `ci95`, and which of them is right; what is not
/// identifiable has no interval to believe. Empty where neither was asked for.
///
/// @param parameters  of the problem's unknowns
/// @param carried     known values whose uncertainty only `ci95` holds
/// @param misfit      whether the model is known to leave more than noise
std::string compare_intervals(const Problem& problem,
                              const std::vector<FittedParameter>& parameters,
                              const std::vector<std::string>& carried = {}, bool misfit = false);

}  // namespace rigcal::calib
