#pragma once

#include <vector>

#include "calib/problem/evaluation.hpp"
#include "calib/problem/problem.hpp"
#include "calib/result/fit_result.hpp"
#include "calib/search/budget.hpp"
#include "calib/search/fit_options.hpp"

namespace rigcal::calib {

/// The problem with one unknown known: same records, weights, tolerance and budgets.
///
/// @param campaign  receives the campaign of that problem, which borrows it
Problem with_known(const Problem& problem, const std::vector<datasets::Record>& records,
                   std::size_t unknown, double value, datasets::Campaign& campaign);

/// Profile likelihood of the unknowns that are no nuisance: from the optimum outwards, all others
/// fitted anew at each fixed value, until 2 cost has risen by (h / standard error)^2 sigma^2, h the
/// half width of `ci95` and sigma^2 as in uncertainty(): a quadratic cost gives `ci95` again, so
/// that correlated residuals widen a profile as they widen the robust error. The crossing is
/// found to 2 % of the distance. An end that meets a bound outside `ci95` first is open, and the
/// parameter then not identifiable. One where no fit converged is lost, which says nothing of the
/// parameter.
///
/// @param fit     with parameters of the problem's unknowns; receives the profiles
/// @param left  the budget of the whole job. A
///                profile that a limit of evaluations overtakes is made to its end
void profiles(const Problem& problem, const std::vector<datasets::Record>& records,
              const Evaluation& optimum, const FitOptions& options, Fit& fit, Budget& left);

}  // namespace rigcal::calib
