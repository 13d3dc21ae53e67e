#pragma once

#include <string>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/fit_result.hpp"
#include "calib/search/optimum.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// Advises, in words, which errors to use and why. Away from a minimum no errors are valid. At a
/// minimum, the advice depends on the correlation of the residuals, and on whether they contain
/// more than noise.
std::string interval_advice(const Problem& problem, const OptimumCheck& check,
                            const Uncertainty& found, const std::vector<LackOfFit>& tests);

/// Describes the differences between repeats; std::nullopt if no condition has single repeats.
std::optional<BetweenRepeats> between_repeats(const Problem& problem, const Uncertainty& found);

/// Explains the differences between repeats, their effect on the intervals, and a remedy. Empty if
/// the repeats differ by no more than their noise.
std::string between_repeats_warning(const BetweenRepeats& repeats);

/// Explains, in words, the errors in channels whose residuals contain no noise.
std::string noiseless_warning(const Problem& problem, const Uncertainty& found);

/// Explains where bootstrap or profile differ from `ci95`, and which interval to use. A parameter
/// that is not identifiable has no valid interval. Empty if neither was requested.
///
/// @param parameters  parameters of the problem's unknowns
/// @param carried     known values whose uncertainty is included only in `ci95`
/// @param misfit      whether there is lack of fit: the residuals contain more than noise
std::string compare_intervals(const Problem& problem,
                              const std::vector<FittedParameter>& parameters,
                              const std::vector<std::string>& carried = {}, bool misfit = false);

}  // namespace rigcal::calib
