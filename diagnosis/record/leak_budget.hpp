#pragma once

#include <vector>

#include "calib/result/uncertainty_budget.hpp"
#include "diagnosis/record/leak_estimate.hpp"

// The contributions to the uncertainty of a leak: its own record, the rig, the effects that the
// model leaves out, the days.

namespace rigcal::diagnosis {

/// Returns the uncertainty budget of a coefficient. `combined` is error.total().
///
/// @param of_rig  RigFit::contributions() for the coefficient
calib::Budget95 coefficient_budget(const CoefficientError& error,
                                   const std::vector<calib::BudgetLine>& of_rig);

/// Returns the uncertainty budget of a share to first order, in percentage points. The degrees of
/// freedom are those of the coefficient, as for the interval.
///
/// @param error        error of the coefficient
/// @param share_slope  d share / d coefficient
/// @param of_rig       RigFit::contributions() for the share, as a fraction of the flow
/// @param days_se      error of the share due to days, as a fraction of the flow
calib::Budget95 share_budget(const CoefficientError& error, double share_slope,
                             const std::vector<calib::BudgetLine>& of_rig, double days_se);

}  // namespace rigcal::diagnosis
