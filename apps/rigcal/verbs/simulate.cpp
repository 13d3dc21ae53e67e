#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/verb.hpp"
#include "common/suggest.hpp"
#include "report/run/chosen_condition.hpp"
#include "report/run/simulation_file.hpp"
#include "report/store/folder.hpp"

namespace rigcal::app {
namespace {

using calib::SimulationTask;
using datasets::Campaign;
using datasets::Condition;
using datasets::Record;

struct SimulateRequest {
  CampaignOptions common;
  std::vector<std::string> conditions;
};

std::vector<const Condition*> wanted(const Campaign& campaign,
                                     const std::vector<std::string>& ids) {
  std::vector<const Condition*> result;
  if (ids.empty()) {
    for (const Condition& condition : campaign.conditions) {
      if (condition.use != datasets::Use::ignore) result.push_back(&condition);
    }
    return result;
  }
  for (const std::string& id : ids) {
    const Condition* condition = &report::chosen_condition(campaign, id);
    if (std::find(result.begin(), result.end(), condition) == result.end()) {
      result.push_back(condition);
    }
  }
  return result;
}

std::string line_of(const SimulationTask& task, const model::Simulation& simulation) {
  if (simulation.ok()) {
    return fmt::format("{}: {} samples, {} steps\n", task.condition->id, task.time_s.size(),
                       simulation.steps);
  }
  return fmt::format("{}: {} at {:.6g} s: {}\n", task.condition->id, to_string(simulation.status),
                     simulation.failed_at_s, simulation.reason);
}

report::Json json_of(const SimulationTask& task, const model::Simulation& simulation) {
  report::Json json;
  json["condition"] = task.condition->id;
  json["status"] = std::string(to_string(simulation.status));
  json["samples"] = task.time_s.size();
  json["steps"] = simulation.steps;
  json["failed_at_s"] =
      simulation.ok() ? report::Json(nullptr) : report::json_of(simulation.failed_at_s);
  json["reason"] = simulation.ok() ? report::Json(nullptr) : report::Json(simulation.reason);
  return json;
}

/// Loads the campaign with the values to simulate.
Campaign load_to_simulate(const CampaignOptions& options) {
  CampaignOptions unchanged = options;
  unchanged.set.clear();
  Campaign campaign = load(unchanged);
  for (const std::string& assignment : options.set) datasets::set_everywhere(campaign, assignment);
  if (!options.set.empty()) datasets::check_values(campaign);
  return campaign;
}

ExitCode run_simulate(const SimulateRequest& options) {
  const Campaign campaign = load_to_simulate(options.common);
  std::vector<SimulationTask> tasks;
  std::vector<Record> records;
  for (const Condition* condition : wanted(campaign, options.conditions)) {
    tasks.push_back(calib::simulation_task(campaign, *condition));
    if (tasks.back().record) records.push_back(*tasks.back().record);
  }
  report::HeldFolder held(options.common.out,
                          holding("simulate", options.common.force, options.common.print));
  report::PlannedFiles planned;
  for (const SimulationTask& task : tasks) planned.files.emplace_back(task.condition->id + ".csv");
  held.plan(std::move(planned));

  const auto simulations =
      calib::simulate(tasks, calib::simulation_options(campaign), options.common.threads);

  std::vector<report::ResultFile> files;
  std::string text;
  std::string problems;
  report::Json json = report::Json::array();
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    files.push_back(
        {tasks[i].condition->id + ".csv", report::simulation_file(tasks[i], simulations[i])});
    text += line_of(tasks[i], simulations[i]);
    if (!simulations[i].ok()) problems += line_of(tasks[i], simulations[i]);
    json.push_back(json_of(tasks[i], simulations[i]));
  }
  report::write_results(held, files, report::hash_inputs(campaign, records));
  text += fmt::format("files: {}\n", (options.common.out / "").string());
  print(options.common.print, text, json);
  if (problems.empty()) return ExitCode::done;
  problems.pop_back();
  throw NoResultError(problems);
}

}  // namespace

Run add_simulate(CLI::App& verb) {
  const auto options = std::make_shared<SimulateRequest>();
  add_campaign_options(verb, options->common);
  verb.add_option("--condition", options->conditions,
                  "Only this condition; repeatable (default: all that are not ignored)")
      ->allow_extra_args(false);
  return [options](const Invocation&) { return run_simulate(*options); };
}

}  // namespace rigcal::app
