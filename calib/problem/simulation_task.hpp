#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"
#include "model/simulate.hpp"

namespace rigcal::calib {

/// A condition with everything that its simulation needs.
struct SimulationTask {
  const datasets::Condition* condition = nullptr;  ///< owned by the campaign
  model::Rig rig;
  model::ParameterValues values;
  model::SimulationInputs inputs;
  std::vector<double> time_s;
  std::optional<datasets::Record> record;  ///< absent if the drive is generated
  std::vector<int> free = {};              ///< parameters whose sensitivities are requested
};

/// Returns true if simulating a condition requires its record.
bool needs_record(const datasets::Condition& condition);

/// @param values  parameter values in the condition
/// @param record  the record of the condition if it has already been read. The simulation then uses
///                its samples, even if the drive is generated.
/// @throws InputError  if the record cannot be read, or if a recorded waveform has no record
SimulationTask simulation_task(const datasets::Campaign& campaign,
                               const datasets::Condition& condition, model::ParameterValues values,
                               std::optional<datasets::Record> record = std::nullopt);
/// Makes a task with the campaign's own values.
SimulationTask simulation_task(const datasets::Campaign& campaign,
                               const datasets::Condition& condition);

/// Returns the simulation settings of the campaign.
model::SimulationOptions simulation_options(const datasets::Campaign& campaign);

/// Simulates all outputs of each task, with their sensitivities to the parameters in `free`. A
/// failure is reported in the status.
std::vector<model::Simulation> simulate(const std::vector<SimulationTask>& tasks,
                                        const model::SimulationOptions& options, int threads);

/// Returns the reference of the control loop at each sample, SI; empty if there is no controller.
std::vector<double> reference_of(const SimulationTask& task);

}  // namespace rigcal::calib
