#include "report/fmu/variables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "model/fmi/references.hpp"

namespace rigcal::report {
namespace {

using model::ExportedRig;
using model::Layout;
using model::Output;
using model::ParameterSpec;

struct OutputRow {
  Output output;
  const char* name;
  const char* unit;
  const char* meaning;
};
constexpr std::array kOutputs{
    OutputRow{Output::position, "position", "m", "position of the piston"},
    OutputRow{Output::velocity, "velocity", "m/s", "velocity of the piston"},
    OutputRow{Output::load_pressure, "load_pressure", "Pa",
              "pressure of chamber A minus that of B"},
    OutputRow{Output::pressure_a, "pressure_a", "Pa", "pressure of chamber A"},
    OutputRow{Output::pressure_b, "pressure_b", "Pa", "pressure of chamber B"},
    OutputRow{Output::force, "force", "N", "reading of a load cell in the rod"},
    OutputRow{Output::command, "command", "V", "command to the valve"},
    OutputRow{Output::spool, "spool", "m", "travel of the valve's spool"},
    OutputRow{Output::servo_flow, "servo_flow", "m3/s", "flow of the servo valve to the load"},
    OutputRow{Output::leakage_flow, "leakage_flow", "m3/s", "internal leakage across the piston"},
    OutputRow{Output::work_flow, "work_flow", "m3/s", "flow that moves the piston"},
    OutputRow{Output::acceleration, "acceleration", "m/s2", "acceleration of the piston"},
    OutputRow{Output::payload_acceleration, "payload_acceleration", "m/s2",
              "acceleration of the second mass"},
    OutputRow{Output::angle, "angle", "rad", "angle of the joint"},
    OutputRow{Output::angular_velocity, "angular_velocity", "rad/s",
              "angular velocity of the joint"},
    OutputRow{Output::pilot_pressure, "pilot_pressure", "Pa", "pilot pressure of the spool"},
    OutputRow{Output::torque, "torque", "N m", "moment that the actuator transmits to the arm"},
};
static_assert(kOutputs.size() == model::kAllOutputs.size(), "every output has a row");

FmuVariable made(std::string_view name, unsigned reference, Causality causality,
                 std::string_view unit, std::string_view meaning) {
  FmuVariable variable;
  variable.name = name;
  variable.reference = reference;
  variable.causality = causality;
  variable.unit = unit;
  variable.meaning = meaning;
  return variable;
}

FmuVariable input(unsigned number, const char* name, const char* unit, const char* meaning,
                  double start) {
  FmuVariable variable =
      made(name, model::kInputReference + number, Causality::input, unit, meaning);
  variable.start = start;
  return variable;
}

void add_inputs(const ExportedRig& rig, std::vector<FmuVariable>& variables) {
  if (rig.rig.controller == model::ControllerKind::pid) {
    const model::FeedbackRow& loop = model::gain_keys(rig.rig.feedback);
    variables.push_back(input(0, "reference", loop.unit.data(), loop.meaning.data(), 0.0));
  } else if (has_output(rig.values, Output::pilot_pressure)) {
    variables.push_back(input(0, "pilot_pressure", "Pa", "pilot pressure of the spool", 0.0));
  } else {
    variables.push_back(input(0, "command", "V", "command to the valve", 0.0));
  }
  if (model::parameter_index(rig.rig.plant, "external_force") >= 0)
    variables.push_back(input(1, "external_force", "N", "load, opposing positive travel",
                              rig.values["external_force"]));
  else
    variables.push_back(input(1, "external_moment", "N m",
                              "moment against positive angle, added to that of the load", 0.0));
  variables.push_back(
      input(2, "supply_pressure", "Pa", "supply above tank", rig.values["supply_pressure"]));
  if (model::parameter_index(rig.rig.plant, "tank_pressure") >= 0)
    variables.push_back(input(3, "tank_pressure", "Pa", "pressure at the valve's tank port",
                              rig.values["tank_pressure"]));
}

/// Returns true if the tick of the sampled controller sets this state.
bool of_sampled_loop(const Layout& layout, std::size_t state) {
  return layout.sampled() && layout.of_controller(static_cast<int>(state));
}

void add_states(const ExportedRig& rig, const Layout& layout, std::vector<FmuVariable>& variables) {
  const auto states = model::describe_states(rig, layout);
  for (std::size_t i = 0; i < states.size(); ++i) {
    // The plant states come first; they are also outputs.
    const bool is_output = static_cast<int>(i) < layout.plant_states;
    FmuVariable variable =
        made(states[i].name, model::kStateReference + static_cast<unsigned>(i),
             is_output ? Causality::output : Causality::local, states[i].unit, states[i].meaning);
    variable.nominal = states[i].nominal;
    variable.is_state = true;
    variable.changes_at_ticks = of_sampled_loop(layout, i);
    variables.push_back(variable);
  }
}

void add_outputs(const ExportedRig& rig, std::vector<FmuVariable>& variables) {
  for (const OutputRow& row : kOutputs) {
    const bool drives = row.output == Output::command || row.output == Output::pilot_pressure;
    if (drives && rig.rig.controller == model::ControllerKind::none) continue;  // it is the input
    if (!has_output(rig.values, row.output)) continue;
    const bool is_state = std::any_of(variables.begin(), variables.end(),
                                      [&](const auto& each) { return each.name == row.name; });
    if (is_state) continue;
    variables.push_back(made(row.name, model::kOutputReference + static_cast<unsigned>(row.output),
                             Causality::output, row.unit, row.meaning));
  }
}

std::string rate_unit(const std::string& unit) {
  if (unit == "s") return "1";
  if (unit == "m/s") return "m/s2";
  if (unit == "m/s2") return "m/s3";
  if (unit == "rad/s") return "rad/s2";
  if (unit == "Pa/s") return "Pa/s2";
  if (unit == "V/s") return "V/s2";
  return unit + "/s";
}

void add_derivatives(std::vector<FmuVariable>& variables) {
  const std::size_t before = variables.size();
  unsigned state = 0;
  for (std::size_t i = 0; i < before; ++i) {
    if (!variables[i].is_state) continue;
    FmuVariable variable =
        made("der(" + variables[i].name + ")", model::kDerivativeReference + state++,
             Causality::local, rate_unit(variables[i].unit), "rate of " + variables[i].name);
    variable.derivative_of = i + 1;
    variables.push_back(variable);
  }
}

void add_parameters(const ExportedRig& rig, std::vector<FmuVariable>& variables) {
  for (const int index : model::exported_parameters(rig)) {
    const ParameterSpec& spec = model::parameter_spec(rig.rig.plant, index);
    FmuVariable variable = made(spec.key, model::kParameterReference + static_cast<unsigned>(index),
                                Causality::parameter, spec.unit, spec.meaning);
    variable.tunable = model::is_tunable(spec);
    variable.start = rig.values.value[static_cast<std::size_t>(index)];
    if (std::isfinite(spec.lower)) variable.lower = spec.lower;
    if (std::isfinite(spec.upper)) variable.upper = spec.upper;
    variables.push_back(variable);
  }
}

}  // namespace

std::vector<FmuVariable> fmu_variables(const ExportedRig& rig, const Layout& layout) {
  std::vector<FmuVariable> variables;
  add_inputs(rig, variables);
  add_states(rig, layout, variables);
  add_outputs(rig, variables);
  add_derivatives(variables);
  add_parameters(rig, variables);
  return variables;
}

}  // namespace rigcal::report
