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

/// Whether the simulation of a condition needs its record.
bool needs_record(const datasets::Condition& condition);

/// @param values  parameter values in the condition
/// @param record  the record of the condition, if it has been read already. The simulation then
///                uses its samples, even with a generated drive.
/// @throws InputError  if the record cannot be read, or a recorded waveform has none
SimulationTask simulation_task(const datasets::Campaign& campaign,
                               const datasets::Condition& condition, model::ParameterValues values,
                               std::optional<datasets::Record> record = std::nullopt);
/// Creates a task with the campaign's own values.
SimulationTask simulation_task(const datasets::Campaign& campaign,
                               const datasets::Condition& condition);

/// Simulation settings of the campaign.
model::SimulationOptions simulation_options(const datasets::Campaign& campaign);

/// Simulates each task: all its outputs, with the sensitivities to its `free`. A failure is
/// reported in the status.
std::vector<model::Simulation> simulate(const std::vector<SimulationTask>& tasks,
                                        const model::SimulationOptions& options, int threads);

/// Reference of the loop at the samples, SI; empty without a controller.
std::vector<double> reference_of(const SimulationTask& task);

}  // namespace rigcal::calib
