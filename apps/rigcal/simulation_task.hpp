#pragma once

#include <optional>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"
#include "model/simulate.hpp"

namespace rigcal::app {

/// A condition with all that its simulation needs.
struct SimulationTask {
  const datasets::Condition* condition = nullptr;
  model::Rig rig;
  model::ParameterValues values;
  model::SimulationInputs inputs;
  std::vector<double> time_s;
  std::optional<datasets::Record> record;  ///< where the condition does not say enough without
};

/// @param values  that hold in the condition
/// @throws InputError  its record cannot be read, or there is none where the waveform is recorded
SimulationTask simulation_task(const datasets::Campaign& campaign,
                               const datasets::Condition& condition, model::ParameterValues values);

/// @throws UsageError  of --condition: no condition has this id
const datasets::Condition& chosen_condition(const datasets::Campaign& campaign,
                                            const std::string& id);

}  // namespace rigcal::app
