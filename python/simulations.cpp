#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/error.hpp"
#include "common/suggest.hpp"
#include "python/arrays.hpp"
#include "python/campaign.hpp"
#include "python/interruptible.hpp"
#include "python/result.hpp"
#include "report/job/job.hpp"

namespace rigcal::python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;

struct Simulated {
  std::string condition;
  std::vector<double> time_s;
  std::vector<double> reference;
  bool of_position = true;        ///< whether the loop controls the position
  std::vector<std::string> free;  ///< parameters for which there are sensitivities
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

/// Returns true if the rig has this signal. Every rig has the payload acceleration, which is zero
/// without a second mass.
bool is_signal(const SimulatedPtr& self, model::Output output) {
  return output == model::Output::payload_acceleration || has_output(self->values, output);
}

using Signals = Dict<std::string, py::array_t<double>>;

Signals signals_of(const SimulatedPtr& self) {
  Signals signals;
  for (std::size_t i = 0; i < model::kAllOutputs.size(); ++i) {
    const model::Output output = model::kAllOutputs[i];
    if (!is_signal(self, output)) continue;
    const std::string_view name = output_name(output);
    signals[py::str(name.data(), name.size())] = signal(self, i);
  }
  return signals;
}

/// Returns, for each parameter, the derivatives of all signals with respect to it.
Dict<std::string, Signals> sensitivities_of(const SimulatedPtr& self) {
  Dict<std::string, Signals> all;
  for (std::size_t j = 0; j < self->free.size(); ++j) {
    Signals of_parameter;
    for (std::size_t i = 0; i < self->simulation.sensitivities.size(); ++i) {
      if (!is_signal(self, model::kAllOutputs[i])) continue;
      const Eigen::MatrixXd& matrix = self->simulation.sensitivities[i];
      const std::string_view name = output_name(model::kAllOutputs[i]);
      of_parameter[py::str(name.data(), name.size())] =
          view(self, matrix.col(static_cast<Eigen::Index>(j)).data(),
               static_cast<std::size_t>(matrix.rows()));
    }
    all[py::str(self->free[j])] = of_parameter;
  }
  return all;
}

/// What a call changes in the task of a condition.
struct Wanted {
  std::map<std::string, double> values;  ///< in SI units
  std::vector<std::string> free;
};

/// Returns the row of a parameter in the plant's table.
///
/// @throws UsageError  if no parameter has this name
int row_of(const char* argument, const std::string& key, model::PlantKind plant) {
  const int index = model::parameter_index(plant, key);
  if (index >= 0) return index;
  std::vector<std::string> known;
  for (const model::ParameterSpec& spec : model::parameter_table(plant))
    known.emplace_back(spec.key);
  throw UsageError(std::string(argument) + ": " + unknown_name_message("parameter", key, known));
}

calib::SimulationTask task_of(const Campaign& self, const datasets::Condition& condition,
                              const Wanted& wanted) {
  model::ParameterValues values = datasets::values_in(self.campaign, condition);
  for (const auto& [key, value] : wanted.values)
    values.set(row_of("values", key, values.plant), value);
  std::optional<datasets::Record> record;
  if (calib::needs_record(condition)) record = self.record(condition);
  calib::SimulationTask task =
      calib::simulation_task(self.campaign, condition, std::move(values), std::move(record));
  for (const std::string& key : wanted.free)
    task.free.push_back(row_of("sensitivities", key, task.values.plant));
  return task;
}

/// A condition, or the id of one.
using ConditionArgument = std::variant<std::string, datasets::Condition>;
std::string id_of(const ConditionArgument& condition) {
  if (const auto* id = std::get_if<std::string>(&condition)) return *id;
  return std::get<datasets::Condition>(condition).id;
}

std::vector<SimulatedPtr> simulate(const Campaign& self,
                                   const std::optional<std::string>& condition,
                                   const std::optional<std::map<std::string, double>>& values,
                                   const std::optional<std::vector<std::string>>& sensitivities,
                                   const std::optional<Integer>& threads,
                                   const std::optional<fs::path>& out, bool force) {
  require_path("out", out);
  const Wanted wanted{values.value_or(std::map<std::string, double>{}),
                      sensitivities.value_or(std::vector<std::string>{})};
  for (const auto& [key, value] : wanted.values) {
    if (!std::isfinite(value))
      throw py::value_error(fmt::format("values: found {} for {}, expected a number", value, key));
  }
  report::SimulationRequest request{{}, "condition"};
  if (condition) request.conditions = {*condition};
  request.task = [&](const auto& each) { return task_of(self, each, wanted); };
  std::atomic<bool> cancel{false};
  report::JobTerms terms{"", {}, thread_count(threads), cancel, out.value_or("")};
  std::optional<report::HeldFolder> held;
  terms.hold = [&](report::PlannedFiles planned) {
    if (!out) return;
    held.emplace(*out, holding("simulate", force));
    held->plan(std::move(planned));
  };
  report::JobResult made;
  const auto raised = run_interruptibly(cancel, [&] {
    made = report::simulation_job(self.campaign, request, terms);
    if (out && !cancel) report::write_results(*held, made.files, made.inputs);
  });
  if (raised) std::rethrow_exception(raised);
  std::vector<SimulatedPtr> results;
  for (std::size_t i = 0; i < made.simulations->tasks.size(); ++i) {
    const calib::SimulationTask& task = made.simulations->tasks[i];
    results.push_back(std::make_shared<Simulated>(
        Simulated{task.condition->id, task.time_s, calib::reference_of(task),
                  task.rig.feedback == model::Feedback::position, wanted.free, task.values,
                  std::move(made.simulations->simulations[i])}));
  }
  return results;
}

SimulatedPtr simulate_one(const Campaign& self, const ConditionArgument& condition,
                          const std::optional<std::map<std::string, double>>& values,
                          const std::optional<std::vector<std::string>>& sensitivities,
                          const std::optional<Integer>& threads, const std::optional<fs::path>& out,
                          bool force) {
  return simulate(self, id_of(condition), values, sensitivities, threads, out, force).front();
}

Dict<std::string, SimulatedPtr> simulate_all(
    const Campaign& self, const py::none& /*condition*/,
    const std::optional<std::map<std::string, double>>& values,
    const std::optional<std::vector<std::string>>& sensitivities,
    const std::optional<Integer>& threads, const std::optional<fs::path>& out, bool force) {
  Dict<std::string, SimulatedPtr> by_condition;
  for (const SimulatedPtr& result :
       simulate(self, std::nullopt, values, sensitivities, threads, out, force))
    by_condition[py::str(result->condition)] = result;
  return by_condition;
}

}  // namespace

void bind_simulations(py::module_& module, CampaignClass& campaign) {
  py::class_<Simulated, SimulatedPtr> simulation(
      module, "Simulation",
      "A simulated condition; SI. Its arrays are read-only, and empty if the simulation failed.");
  simulation.def_readonly("condition", &Simulated::condition, "Id of the condition.")
      .def_property_readonly("status", field(&Simulated::simulation, &model::Simulation::status),
                             "\"ok\", or the kind of failure.")
      .def_property_readonly("reason", field(&Simulated::simulation, &model::Simulation::reason),
                             "Why it failed; empty if it did not.")
      .def_property_readonly(
          "failed_at_s",
          [](const Simulated& self) {
            return self.simulation.ok() ? std::nullopt : std::optional(self.simulation.failed_at_s);
          },
          "Time of the failure [s]; None if it did not fail.")
      .def_property_readonly("steps", field(&Simulated::simulation, &model::Simulation::steps),
                             "Number of steps of the solver.")
      .def_property_readonly(
          "time_s", [](const SimulatedPtr& self) { return view(self, self->time_s); },
          "Shape (samples) [s].")
      .def_property_readonly(
          "reference_m",
          [](const SimulatedPtr& self) {
            static const std::vector<double> none;
            return view_or_none(self, self->of_position ? self->reference : none);
          },
          "Position reference, shape (samples) [m]; None without a position loop.")
      .def_property_readonly("signals", &signals_of,
                             "All signals and flows by their names with units,\n"
                             "\"position_m\", \"servo_flow_m3_per_s\"..., each of shape (samples).")
      .def_property_readonly(
          "sensitivities", &sensitivities_of,
          "Derivatives of every signal with respect to each requested parameter, by its\nkey and "
          "then as in `signals`: SI over SI, shape (samples).")
      .def("to_frame", of_notebook<Frame>("to_frame"),
           "Time and signals as a pandas DataFrame; ImportError without pandas.")
      .def(
          "plot",
          [](const py::object& self, const std::optional<std::vector<std::string>>& signals) {
            return Figure(notebook("plot")(self, signals));
          },
          py::arg("signals") = py::none(), R"(Signals over time, by matplotlib.

Args:
    signals: names such as "position_m"; None: the position, or the angle of a joint

Returns:
    the Figure)")
      .def("__repr__", [](const Simulated& self) {
        return fmt::format("<rigcal.Simulation {}: {}, {} samples>", self.condition,
                           to_string(self.simulation.status), self.time_s.size());
      });
  const char* const about[] = {
      "Reading of the position sensor [m].",
      "Velocity of the piston [m/s].",
      "Difference of the chamber pressures [Pa].",
      "[Pa]",
      "[Pa]",
      "Reading of a load cell in the rod [N].",
      "Controller output after the limit, or the recorded command [V].",
      "Travel of the valve spool [m].",
      "Flow of the servo valve to the load [m3/s].",
      "Internal leakage across the piston [m3/s].",
      "Flow that moves the piston [m3/s].",
      "Acceleration of the piston and the mass fixed to it [m/s2].",
      "Acceleration of the second mass [m/s2]; zero without one.",
      "Reading of a joint's angle sensor [rad]; zero without a joint.",
      "Angular velocity of the joint [rad/s]; zero without a joint.",
      "Pilot pressure of the spool [Pa]; zero without a pilot-operated valve.",
      "Reading of a joint's torque sensor [N m]; zero without a joint."};
  static_assert(std::size(about) == model::kAllOutputs.size());
  for (std::size_t i = 0; i < model::kAllOutputs.size(); ++i) {
    const std::string name(output_name(model::kAllOutputs[i]));
    simulation.def_property_readonly(
        name.c_str(), [i](const SimulatedPtr& self) { return signal(self, i); },
        (std::string(about[i]) + " Shape (samples).").c_str());
  }
  // Two overloads, because the type of the result depends on whether a condition is given.
  campaign.def("simulate", &simulate_one, py::arg("condition"), py::kw_only(),
               py::arg("values") = py::none(), py::arg("sensitivities") = py::none(),
               py::arg("threads") = py::none(), py::arg("out") = py::none(),
               py::arg("force") = false,
               R"(Simulates with the campaign's values, as `rigcal simulate`.

A condition that cannot be simulated says so in its status; nothing is raised.

Args:
    condition: the only one to simulate, or its id; None: all that are not ignored
    values: SI values in place of the campaign's, {"mass": 61.0}
    sensitivities: keys of parameters by which the signals are differentiated
    threads: None: as many as the machine has; results do not depend on it
    out: folder for <condition>.csv; None writes nothing
    force: replace files that rigcal did not write, or that were changed since

Returns:
    a Simulation, or a dict of them by the ids of all conditions

Raises:
    InputError: a recording that drives the model is wrong
    UsageError: there is no such condition or parameter, or a file that rigcal did not write would
        be replaced
    ValueError: a value is not finite

Records that drive the model are read once.)");
  campaign.def("simulate", &simulate_all, py::arg("condition") = py::none(), py::kw_only(),
               py::arg("values") = py::none(), py::arg("sensitivities") = py::none(),
               py::arg("threads") = py::none(), py::arg("out") = py::none(),
               py::arg("force") = false,
               "Simulates all conditions that are not ignored; returns a dict by their ids.");
}

}  // namespace rigcal::python
