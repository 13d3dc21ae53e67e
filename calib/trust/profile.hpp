#pragma once

#include <vector>

#include "calib/problem/evaluation.hpp"
#include "calib/problem/problem.hpp"
#include "calib/result/fit_result.hpp"
#include "calib/search/budget.hpp"
#include "calib/search/fit_options.hpp"

namespace rigcal::calib {

/// Returns the problem with one unknown fixed. Records, weights, tolerance and budgets are the
/// same.
///
/// @param campaign  receives the campaign of the new problem, which borrows it
Problem with_known(const Problem& problem, const std::vector<datasets::Record>& records,
                   std::size_t unknown, double value, datasets::Campaign& campaign);

/// Computes the profile likelihood of all unknowns except nuisance parameters. Starting from the
/// optimum, all other unknowns are refitted at fixed values ever further from it, until 2 cost has
/// risen by (h / standard error)^2 sigma^2, where h is the half-width of `ci95_if_exact` and
/// sigma^2 is that of uncertainty(). A quadratic cost therefore reproduces this interval, and
/// correlated residuals widen a profile in the same way as the robust error. The crossing is
/// located to within 2 % of its distance from the optimum. An end is open if the profile first
/// reaches a bound outside the interval; the parameter is then not identifiable. An end is lost if
/// a fit does not converge, which says nothing about the parameter.
///
/// @param fit   contains the parameters of the problem's unknowns; receives the profiles
/// @param left  what remains of the budget of the whole job; a profile that reaches the limit on
///              evaluations is completed
void profiles(const Problem& problem, const std::vector<datasets::Record>& records,
              const Evaluation& optimum, const FitOptions& options, Fit& fit, Budget& left);

}  // namespace rigcal::calib
