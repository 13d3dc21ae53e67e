#pragma once

#include <vector>

#include "datasets/campaign/campaign.hpp"

namespace rigcal::calib {

/// Values in a condition with those of a fit in place of the rig's. Values that the campaign states
/// for the condition or its leak level have priority. Nuisance parameters stay unchanged.
///
/// @throws InputError  a parameter that the campaign fits, or that was fitted per leak level or
///                     condition, has no value for this one (names it and the levels that exist)
model::ParameterValues values_with(const datasets::Campaign& campaign,
                                   const datasets::Condition& condition,
                                   const std::vector<datasets::FittedValue>& fitted);

}  // namespace rigcal::calib
