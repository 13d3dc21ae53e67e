#pragma once

#include <vector>

#include "datasets/campaign/campaign.hpp"

namespace rigcal::calib {

/// Returns the parameter values in a condition, with fitted values replacing those of the rig.
/// Values that the campaign gives for the condition or its leak level take precedence. Nuisance
/// parameters keep the campaign's values.
///
/// @throws InputError  if a parameter that the campaign fits, or that was fitted per leak level or
///                     condition, has no value for this one (names it and the levels that exist)
model::ParameterValues values_with(const datasets::Campaign& campaign,
                                   const datasets::Condition& condition,
                                   const std::vector<datasets::FittedValue>& fitted);

}  // namespace rigcal::calib
