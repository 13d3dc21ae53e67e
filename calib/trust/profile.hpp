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

/// Profile likelihood of all unknowns except nuisance parameters. From the optimum outwards all
/// others are fitted again at each fixed value, until 2 cost has risen by (h / standard error)^2
/// sigma^2; h is the half width of `ci95`, and sigma^2 as in uncertainty(). A quadratic cost thus
/// reproduces `ci95`, and correlated residuals widen a profile as they widen the robust error. The
/// crossing is found to 2 % of the distance. An end that meets a bound outside `ci95` first is
/// open, and the parameter is then not identifiable. An end where no fit converged is lost, which
/// says nothing about the parameter.
///
/// @param fit     has parameters of the problem's unknowns; receives the profiles
/// @param left    rest of the budget of the whole job; a profile that reaches a limit of
///                evaluations is completed
void profiles(const Problem& problem, const std::vector<datasets::Record>& records,
              const Evaluation& optimum, const FitOptions& options, Fit& fit, Budget& left);

}  // namespace rigcal::calib
