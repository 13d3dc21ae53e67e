#pragma once

#include "calib/problem/problem.hpp"
#include "calib/result/fit_result.hpp"

namespace rigcal::calib {

/// Estimates the parameters of a fit once more, from the validation records alone: Gauss-Newton
/// steps from the fit's values, and the error of each by the scatter of their residuals. Into
/// `stability` of the fit goes how far each estimate moves, and whether that is more than both
/// uncertainties allow (5 %, all parameters together by Holm). What the validation records
/// determine to no better than 25 % is left out.
///
/// @param validation  the problem of the validation records with the unknowns of the fit
/// @param nuisance    estimated from the validation records already
/// @param fit         converged, with the budgets of its parameters
void repeat_on_validation(Problem validation, const std::vector<FittedParameter>& nuisance,
                          int threads, const std::atomic<bool>* cancel, Fit& fit);

}  // namespace rigcal::calib
