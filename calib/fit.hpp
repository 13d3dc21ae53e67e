#pragma once

#include <vector>

#include "calib/result/fit_result.hpp"
#include "calib/result/origin.hpp"
#include "calib/search/fit_options.hpp"
#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::calib {

/// Calibrates the free parameters on the `fit` conditions by Ceres (analytic Jacobian, unit box)
/// and scores `fit` and `validate` conditions. Never throws for a fit that fails: see status.
///
/// @param records  of the fit and validate conditions, found by their `condition`
/// @throws InputError  nothing is free, no `fit` condition, a channel without any weight...
Fit fit(const datasets::Campaign& campaign, const std::vector<datasets::Record>& records,
        const FitOptions& options);

/// Scores `fit` and `validate` conditions with given values. Estimates only nuisance parameters (by
/// the same code as fit()).
///
/// @param values  of an earlier fit, or empty: the campaign's own values
/// @param origin  of `values`; null: they are assumed to be estimated from the campaign's `fit`
///                conditions
/// @throws InputError  `values` lacks a value for a leak level or condition
Fit validate(const datasets::Campaign& campaign, const std::vector<datasets::Record>& records,
             const std::vector<datasets::FittedValue>* values, const FitOptions& options,
             const Origin* origin = nullptr);

}  // namespace rigcal::calib
