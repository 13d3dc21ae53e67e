#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "report/job/job.hpp"
#include "report/run/campaign_choice.hpp"
#include "report/store/csv.hpp"

namespace rigcal::report {
namespace {

using calib::SimulationTask;
using datasets::Condition;

std::vector<const Condition*> wanted(const datasets::Campaign& campaign,
                                     const SimulationRequest& request) {
  std::vector<const Condition*> result;
  if (request.conditions.empty()) {
    for (const Condition& condition : campaign.conditions) {
      if (condition.use != datasets::Use::ignore) result.push_back(&condition);
    }
    return result;
  }
  for (const std::string& id : request.conditions) {
    const Condition* condition = &chosen_condition(campaign, id, request.argument);
    if (std::find(result.begin(), result.end(), condition) == result.end())
      result.push_back(condition);
  }
  return result;
}

std::string file_of(const SimulationTask& task) { return task.condition->id + ".csv"; }

std::string line_of(const SimulationTask& task, const model::Simulation& simulation) {
  if (simulation.ok()) {
    return fmt::format("{}: {} samples, {} steps\n", task.condition->id, task.time_s.size(),
                       simulation.steps);
  }
  return fmt::format("{}: {} at {:.6g} s: {}\n", task.condition->id, to_string(simulation.status),
                     simulation.failed_at_s, simulation.reason);
}

Json simulation_json(const SimulationTask& task, const model::Simulation& simulation) {
  Json json;
  json["condition"] = task.condition->id;
  json["status"] = std::string(to_string(simulation.status));
  json["samples"] = task.time_s.size();
  json["steps"] = simulation.steps;
  json["failed_at_s"] = simulation.ok() ? Json(nullptr) : json_of(simulation.failed_at_s);
  json["reason"] = simulation.ok() ? Json(nullptr) : Json(simulation.reason);
  return json;
}

}  // namespace

JobResult simulation_job(const datasets::Campaign& campaign, const SimulationRequest& request,
                         const JobTerms& terms) {
  const auto run = std::make_shared<SimulationRun>();
  std::vector<datasets::Record> records;
  PlannedFiles planned;
  for (const Condition* condition : wanted(campaign, request)) {
    const SimulationTask& task = run->tasks.emplace_back(
        request.task ? request.task(*condition) : calib::simulation_task(campaign, *condition));
    if (task.record) records.push_back(*task.record);
    planned.files.emplace_back(file_of(task));
  }
  terms.hold(std::move(planned));
  model::SimulationOptions settings = calib::simulation_options(campaign);
  settings.cancel = &terms.cancel;
  run->simulations = calib::simulate(run->tasks, settings, terms.threads);
  JobResult job;
  job.simulations = run;
  if (terms.out.empty() || terms.cancel) return job;
  Printed& printed = job.printed.emplace();
  printed.json = Json::array();
  for (std::size_t i = 0; i < run->tasks.size(); ++i) {
    const SimulationTask& task = run->tasks[i];
    const model::Simulation& simulation = run->simulations[i];
    job.files.push_back({file_of(task), simulation_csv(task, simulation)});
    printed.text += line_of(task, simulation);
    if (!simulation.ok()) printed.problems += line_of(task, simulation);
    printed.json.push_back(simulation_json(task, simulation));
  }
  if (!printed.problems.empty()) printed.problems.pop_back();
  job.first = {""};
  job.inputs = hash_inputs(campaign, records);
  return job;
}

}  // namespace rigcal::report
