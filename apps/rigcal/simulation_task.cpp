#include "apps/rigcal/simulation_task.hpp"

#include <fmt/format.h>

#include <utility>

#include "calib/problem/initial_state.hpp"
#include "common/error.hpp"
#include "common/suggest.hpp"
#include "datasets/prepare/load_record.hpp"

namespace rigcal::app {

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

const Condition& chosen_condition(const Campaign& campaign, const std::string& id) {
  if (const Condition* condition = campaign.find(id)) return *condition;
  std::vector<std::string> known;
  for (const Condition& condition : campaign.conditions) known.push_back(condition.id);
  throw UsageError("--condition: " + unknown_name_message("condition", id, known));
}

}  // namespace rigcal::app
