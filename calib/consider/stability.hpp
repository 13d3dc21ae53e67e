#pragma once

#include "calib/problem/problem.hpp"
#include "calib/result/fit_result.hpp"

namespace rigcal::calib {

/// Estimates the parameters of a fit again, from the validation records only. The function takes
/// Gauss-Newton steps from the fit's values, and computes the error of each estimate from the
/// residuals. It stores in `fit.stability` how far each estimate moves, and whether this exceeds
/// the uncertainty of both estimates (at 5 % for all parameters together, Holm). Parameters that
/// the validation records do not determine to within 25 % are omitted. If a validation record was
/// made on another day than the fitted ones, both estimates have the error of their days, too.
///
/// @param validation  the problem for the validation records, with the unknowns of the fit
/// @param nuisance    values already estimated from the validation records
/// @param dates       dates of the fitted records; empty if not all are known
/// @param fit         must have converged, and contain the uncertainty budgets of its parameters
void repeat_on_validation(Problem validation, const std::vector<FittedParameter>& nuisance,
                          const std::vector<std::string>& dates, int threads,
                          const std::atomic<bool>* cancel, Fit& fit);

}  // namespace rigcal::calib
