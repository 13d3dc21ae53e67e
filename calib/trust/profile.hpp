#pragma once

#include <vector>

#include "calib/problem/evaluation.hpp"
#include "calib/problem/problem.hpp"
#include "calib/result/fit_result.hpp"
#include "calib/search/budget.hpp"
#include "calib/search/fit_options.hpp"

namespace rigcal::calib {

/// Returns the problem with one unknown fixed, and with the same records, weights, tolerance and
/// budgets.
///
/// @param campaign  receives the campaign of the new problem, which borrows it
Problem with_known(const Problem& problem, const std::vector<datasets::Record>& records,
                   std::size_t unknown, double value, datasets::Campaign& campaign);

/// Computes the profile likelihood of all unknowns except nuisance parameters. From the optimum
/// outwards, all other unknowns are refitted at each fixed value until 2 cost has risen by (h /
/// standard error)^2 sigma^2, where h is the half-width of `ci95` and sigma^2 is as in
/// uncertainty(). A quadratic cost thus reproduces `ci95`, and correlated residuals widen a profile
/// in the same way as the robust error. The crossing is located to 2 % of its distance. An end is
/// open if it meets a bound outside `ci95` first; the parameter is then not identifiable. An end is
/// lost if a fit did not converge; this says nothing about the parameter.
///
/// @param fit   contains the parameters of the problem's unknowns; receives the profiles
/// @param left  remaining budget of the whole job; a profile that reaches a limit on evaluations is
///              completed
void profiles(const Problem& problem, const std::vector<datasets::Record>& records,
              const Evaluation& optimum, const FitOptions& options, Fit& fit, Budget& left);

}  // namespace rigcal::calib
