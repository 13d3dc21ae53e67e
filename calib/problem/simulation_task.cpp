#include "calib/problem/simulation_task.hpp"

#include <fmt/format.h>

#include <utility>

#include "calib/problem/initial_state.hpp"
#include "common/error.hpp"
#include "common/parallel.hpp"
#include "datasets/prepare/load_record.hpp"
#include "datasets/prepare/time_holes.hpp"

namespace rigcal::calib {

using datasets::Campaign;
using datasets::Condition;
using datasets::Record;

bool needs_record(const Condition& condition) {
  const bool generated = condition.waveform != datasets::Waveform::recorded &&
                         condition.duration_s && condition.sample_rate_hz;
  return !generated && condition.has_record();
}

SimulationTask simulation_task(const Campaign& campaign, const Condition& condition,
                               model::ParameterValues values, std::optional<Record> known) {
  SimulationTask task;
  task.condition = &condition;
  task.rig = campaign.rig;
  task.values = std::move(values);
  if (known || needs_record(condition)) {
    task.record = known ? std::move(known) : datasets::load_record(campaign, condition);
    datasets::require_no_holes(campaign, *task.record);
    const InitialPlan plan = plan_initial_state(campaign, condition, *task.record, task.values);
    task.rig.initial = plan.state;
    for (const auto& [index, value] : plan.known) task.values.set(index, value);
  } else if (condition.waveform == datasets::Waveform::recorded) {
    throw InputError(condition.where,
                     fmt::format("condition \"{}\": the waveform is \"recorded\", but there is no "
                                 "record; expected repeats or averaged",
                                 condition.id));
  }
  const Record* record = task.record ? &*task.record : nullptr;
  task.time_s = datasets::sample_times(condition, record);
  task.inputs = datasets::inputs_of(campaign, condition, task.values, record);
  return task;
}

SimulationTask simulation_task(const Campaign& campaign, const Condition& condition) {
  return simulation_task(campaign, condition, datasets::values_in(campaign, condition));
}

model::SimulationOptions simulation_options(const Campaign& campaign) {
  model::SimulationOptions options;
  options.method = campaign.simulation.method;
  options.tolerance = campaign.simulation.tolerance.value_or(options.tolerance);
  options.max_seconds = campaign.simulation.max_seconds;
  return options;
}

std::vector<model::Simulation> simulate(const std::vector<SimulationTask>& tasks,
                                        const model::SimulationOptions& options, int threads) {
  std::vector<model::Simulation> simulations(tasks.size());
  parallel_for(tasks.size(), threads, [&](std::size_t i) {
    const SimulationTask& task = tasks[i];
    simulations[i] = model::simulate(task.rig, task.values, task.free, task.inputs, task.time_s,
                                     model::kAllOutputs, options);
  });
  return simulations;
}

std::vector<double> reference_of(const SimulationTask& task) {
  std::vector<double> reference;
  if (task.rig.controller == model::ControllerKind::pid) {
    for (const double t : task.time_s) reference.push_back(task.inputs.drive.value(t));
  }
  return reference;
}

}  // namespace rigcal::calib
