#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "common/suggest.hpp"
#include "python/arrays.hpp"
#include "python/campaign.hpp"
#include "python/holding.hpp"
#include "python/interruptible.hpp"
#include "report/run/simulation.hpp"
#include "report/store/folder.hpp"
#include "report/store/provenance.hpp"

namespace rigcal::python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;

/// A simulated condition.
struct Simulated {
  std::string condition;
  std::vector<double> time_s;
  std::vector<double> reference;
  bool of_position = true;  ///< whether the loop controls the position
  model::ParameterValues values;
  model::Simulation simulation;
};
using SimulatedPtr = std::shared_ptr<Simulated>;

py::array_t<double> signal(const SimulatedPtr& self, std::size_t output) {
  const Eigen::MatrixXd& outputs = self->simulation.outputs;
  if (outputs.size() == 0) return view<double>(self, nullptr, 0);
  return view(self, outputs.col(static_cast<Eigen::Index>(output)).data(),
              static_cast<std::size_t>(outputs.rows()));
}

py::dict signals_of(const SimulatedPtr& self) {
  py::dict signals;
  for (std::size_t i = 0; i < model::kAllOutputs.size(); ++i) {
    const model::Output output = model::kAllOutputs[i];
    if (output != model::Output::payload_acceleration && !has_output(self->values, output))
      continue;
    const std::string_view name = output_name(output);
    signals[py::str(name.data(), name.size())] = signal(self, i);
  }
  return signals;
}

/// @throws UsageError  there is no such condition
std::vector<const datasets::Condition*> wanted(const datasets::Campaign& campaign,
                                               const std::optional<std::string>& id) {
  std::vector<const datasets::Condition*> conditions;
  std::vector<std::string> known;
  for (const datasets::Condition& condition : campaign.conditions) {
    known.push_back(condition.id);
    if (id ? condition.id == *id : condition.use != datasets::Use::ignore)
      conditions.push_back(&condition);
  }
  if (id && conditions.empty())
    throw UsageError("condition: " + unknown_name_message("condition", *id, known));
  return conditions;
}

std::vector<SimulatedPtr> simulated(const Campaign& self, const std::optional<std::string>& id,
                                    int threads, const std::optional<fs::path>& out, bool force,
                                    const std::atomic<bool>& cancel) {
  std::vector<report::SimulationTask> tasks;
  std::vector<datasets::Record> records;
  for (const datasets::Condition* condition : wanted(self.campaign, id)) {
    tasks.push_back(report::simulation_task(self.campaign, *condition));
    if (tasks.back().record) records.push_back(*tasks.back().record);
  }
  std::optional<report::HeldFolder> held;
  if (out) {
    held.emplace(*out, holding("simulate", force));
    report::PlannedFiles planned;
    for (const auto& task : tasks) planned.files.emplace_back(task.condition->id + ".csv");
    held->plan(std::move(planned));
  }
  model::SimulationOptions options = report::simulation_options(self.campaign);
  options.cancel = &cancel;
  auto simulations = report::simulate(tasks, options, threads);
  std::vector<SimulatedPtr> results;
  std::vector<report::ResultFile> files;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (out) {
      files.push_back(
          {tasks[i].condition->id + ".csv", report::simulation_file(tasks[i], simulations[i])});
    }
    results.push_back(std::make_shared<Simulated>(
        Simulated{tasks[i].condition->id, tasks[i].time_s, report::reference_of(tasks[i]),
                  tasks[i].rig.feedback == model::Feedback::position, tasks[i].values,
                  std::move(simulations[i])}));
  }
  if (out && !cancel)
    report::write_results(*held, files, report::hash_inputs(self.campaign, records));
  return results;
}

py::object simulate(const Campaign& self, const std::optional<std::string>& condition,
                    const std::optional<Integer>& threads, const std::optional<fs::path>& out,
                    bool force) {
  require_path("out", out);
  const int count = thread_count(threads);
  std::vector<SimulatedPtr> results;
  std::atomic<bool> cancel{false};
  const auto raised = run_interruptibly(
      cancel, [&] { results = simulated(self, condition, count, out, force, cancel); });
  if (raised) std::rethrow_exception(raised);
  if (condition) return py::cast(results.front());
  py::dict by_condition;
  for (const SimulatedPtr& result : results) by_condition[py::str(result->condition)] = result;
  return by_condition;
}

}  // namespace

void bind_simulations(py::module_& module, CampaignClass& campaign) {
  py::class_<Simulated, SimulatedPtr> simulation(
      module, "Simulation",
      "A simulated condition; SI. Its arrays cannot be written to; they are empty where it could\n"
      "not be simulated.");
  simulation.def_readonly("condition", &Simulated::condition, "Id of the condition.")
      .def_property_readonly("status", named(&Simulated::simulation, &model::Simulation::status),
                             "\"ok\", or why there is none.")
      .def_property_readonly("reason", field(&Simulated::simulation, &model::Simulation::reason),
                             "Why it failed, in words; empty if it did not.")
      .def_property_readonly(
          "failed_at_s",
          [](const Simulated& self) {
            return self.simulation.ok() ? std::nullopt : std::optional(self.simulation.failed_at_s);
          },
          "Where it ended [s]; None if it did not fail.")
      .def_property_readonly("steps", field(&Simulated::simulation, &model::Simulation::steps),
                             "Of the solver.")
      .def_property_readonly(
          "time_s", [](const SimulatedPtr& self) { return view(self, self->time_s); },
          "Shape (samples) [s].")
      .def_property_readonly(
          "reference_m",
          [](const SimulatedPtr& self) {
            static const std::vector<double> none;
            return view_or_none(self, self->of_position ? self->reference : none);
          },
          "Position reference, shape (samples) [m]; None where no loop is on position.")
      .def_property_readonly("signals", &signals_of,
                             "All signals and flows by their names with units,\n"
                             "\"position_m\", \"servo_flow_m3_per_s\"..., each of shape (samples).")
      .def("__repr__", [](const Simulated& self) {
        return fmt::format("<rigcal.Simulation {}: {}, {} samples>", self.condition,
                           to_string(self.simulation.status), self.time_s.size());
      });
  const char* const about[] = {"Reading of the position sensor [m].",
                               "Of the piston [m/s].",
                               "Difference of the chamber pressures [Pa].",
                               "[Pa]",
                               "[Pa]",
                               "What a load cell in the rod reads [N].",
                               "Controller output after the limit, or the recorded command [V].",
                               "Travel of the valve spool [m].",
                               "Flow of the servo valve to the load [m3/s].",
                               "Internal leakage across the piston [m3/s].",
                               "Flow that moves the piston [m3/s].",
                               "Of the piston and what is fixed to it [m/s2].",
                               "Of the second mass [m/s2]; zero where there is none.",
                               "Reading of a joint's angle sensor [rad]; zero where there is none.",
                               "Of the joint [rad/s]; zero where there is none.",
                               "Pilot pressure of the spool [Pa]; zero where there is none."};
  static_assert(std::size(about) == model::kAllOutputs.size());
  for (std::size_t i = 0; i < model::kAllOutputs.size(); ++i) {
    const std::string name(output_name(model::kAllOutputs[i]));
    simulation.def_property_readonly(
        name.c_str(), [i](const SimulatedPtr& self) { return signal(self, i); },
        (std::string(about[i]) + " Shape (samples).").c_str());
  }
  campaign.def("simulate", &simulate, py::arg("condition") = py::none(), py::kw_only(),
               py::arg("threads") = py::none(), py::arg("out") = py::none(),
               py::arg("force") = false,
               R"(Simulates with the campaign's values, as `rigcal simulate`.

A condition that cannot be simulated says so in its status; nothing is raised.

Args:
    condition: id of the only one to simulate; None: all that are not ignored
    threads: None: as many as the machine has; results do not depend on it
    out: folder for <condition>.csv; None writes nothing
    force: replace files that rigcal did not write, or that were changed since

Returns:
    a Simulation, or a dict of them by the ids of all conditions

Raises:
    InputError: a recording that drives the model is wrong
    UsageError: there is no such condition, or a file that rigcal did not write would be replaced)");
}

}  // namespace rigcal::python
