#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"
#include "model/simulate.hpp"

namespace rigcal::calib {

/// A condition with all that its simulation needs.
struct SimulationTask {
  const datasets::Condition* condition = nullptr;  ///< owned by the campaign
  model::Rig rig;
  model::ParameterValues values;
  model::SimulationInputs inputs;
  std::vector<double> time_s;
  std::optional<datasets::Record> record;  ///< absent where the drive is made
  std::vector<int> free = {};              ///< parameters whose sensitivities are wanted
};

/// Whether the simulation of a condition needs its record.
bool needs_record(const datasets::Condition& condition);

/// @param values  for the condition
/// @param record  its record, if it has been read before: then its samples, also for a generated
/// drive
/// @throws InputError  its record cannot be read, or a recorded waveform has none
SimulationTask simulation_task(const datasets::Campaign& campaign,
                               const datasets::Condition& condition, model::ParameterValues values,
                               std::optional<datasets::Record> record = std::nullopt);
/// The same with the campaign's own values.
SimulationTask simulation_task(const datasets::Campaign& campaign,
                               const datasets::Condition& condition);

/// Simulation settings of the campaign.
model::SimulationOptions simulation_options(const datasets::Campaign& campaign);

/// Simulates each, every output of it with the sensitivities to its `free`; one that fails says so
/// in its status.
std::vector<model::Simulation> simulate(const std::vector<SimulationTask>& tasks,
                                        const model::SimulationOptions& options, int threads);

/// Reference of the loop at the samples, SI; empty without a controller.
std::vector<double> reference_of(const SimulationTask& task);

}  // namespace rigcal::calib
