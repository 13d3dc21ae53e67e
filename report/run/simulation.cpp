#include "report/run/simulation.hpp"

#include <fmt/format.h>

#include <utility>

#include "calib/problem/initial_state.hpp"
#include "common/error.hpp"
#include "common/parallel.hpp"
#include "datasets/prepare/load_record.hpp"
#include "datasets/prepare/time_holes.hpp"
#include "report/store/csv.hpp"

namespace rigcal::report {

using datasets::Campaign;
using datasets::Condition;
using datasets::Record;

SimulationTask simulation_task(const Campaign& campaign, const Condition& condition,
                               model::ParameterValues values) {
  SimulationTask task;
  task.condition = &condition;
  task.rig = campaign.rig;
  task.values = std::move(values);
  const bool generated = condition.waveform != datasets::Waveform::recorded &&
                         condition.duration_s && condition.sample_rate_hz;
  if (!generated && condition.has_record()) {
    task.record = datasets::load_record(campaign, condition);
    datasets::require_no_holes(campaign, *task.record);
    const calib::InitialPlan plan =
        calib::plan_initial_state(campaign, condition, *task.record, task.values);
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
    simulations[i] = model::simulate(task.rig, task.values, {}, task.inputs, task.time_s,
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

std::string simulation_file(const SimulationTask& task, const model::Simulation& simulation) {
  std::vector<model::Output> outputs;
  for (const model::Output output : model::kAllOutputs)
    if (has_output(task.values, output)) outputs.push_back(output);
  return simulation_csv(task.time_s, info(datasets::drive_channel(task.rig)).name,
                        reference_of(task), outputs, simulation);
}

}  // namespace rigcal::report
