#pragma once

#include <vector>

#include "calib/result/fit_result.hpp"
#include "calib/result/origin.hpp"
#include "calib/search/fit_options.hpp"
#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::calib {

/// Calibrates the free parameters on the `fit` conditions with Ceres (analytic Jacobian, unit box)
/// and scores `fit` and `validate` conditions. A fit that fails is reported in `status`, not
/// thrown.
///
/// @param records  records of the fit and validate conditions, identified by their `condition`
/// @throws InputError  if no parameter is free, there is no `fit` condition, or the input is
///                     unusable in another way, for example because a channel has no weight
Fit fit(const datasets::Campaign& campaign, const std::vector<datasets::Record>& records,
        const FitOptions& options);

/// Scores `fit` and `validate` conditions with given values. Estimates only nuisance parameters,
/// with the same code as fit().
///
/// @param values  values of an earlier fit, or null to use the campaign's own values
/// @param origin  where `values` come from; if null, they are assumed to have been estimated from
///                the campaign's `fit` conditions
/// @throws InputError  if `values` lacks a value for a leak level or condition
Fit validate(const datasets::Campaign& campaign, const std::vector<datasets::Record>& records,
             const std::vector<datasets::FittedValue>* values, const FitOptions& options,
             const Origin* origin = nullptr);

}  // namespace rigcal::calib
