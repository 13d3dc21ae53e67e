#pragma once

#include <string>
#include <vector>

#include "calib/problem/parameter_map.hpp"
#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::calib {

/// Initial state of the simulation of one condition.
struct InitialPlan {
  model::InitialState state = model::InitialState::rest;
  datasets::Overrides known;      ///< initial_* values read from the record
  std::vector<Unknown> unknowns;  ///< initial_* values to estimate, which are nuisance parameters
};

/// Applies the campaign's `initial` to one condition:
///   rest    All states are zero.
///   record  Position, and load pressure if pressures are recorded, are their means over the
///           `initial_window`. The velocity is zero. An unrecorded load pressure is in equilibrium
///           with the load.
///   fit     Position, velocity and load pressure are estimated, with bounds from the record: one
///           peak-to-peak value about the mean of the window, the fastest change between two
///           samples, and the supply pressure (or one peak-to-peak value of the recorded load
///           pressure).
/// Initial values that the campaign itself gives or fits are not changed. A load pressure that is
/// computed from both chamber pressures is corrected for their sensor offsets in `values`.
///
/// @param values  values in the condition: known, from an earlier fit, or start values
/// @throws InputError  if `initial` is record or fit, and no position was recorded
InitialPlan plan_initial_state(const datasets::Campaign& campaign,
                               const datasets::Condition& condition, const datasets::Record& record,
                               const model::ParameterValues& values);

/// Explains why `initial = "record"` is wrong if the piston moves within the window. Empty if it
/// does not move.
std::string moving_start(const datasets::Campaign& campaign,
                         const std::vector<const datasets::Condition*>& conditions,
                         const std::vector<datasets::Record>& records);

}  // namespace rigcal::calib
