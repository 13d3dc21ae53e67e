#include "model/fmi/equations.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "model/plant/terms.hpp"
#include "tests/model/linkage_rig.hpp"
#include "tests/model/sensitivity.hpp"

using namespace rigcal::model;

namespace {

ExportedRig rig_with(const std::vector<std::string>& keys) {
  ExportedRig rig;
  rig.values = paper_rig();
  for (const std::string& key : keys) rig.values.set(key, 1.0);
  return rig;
}

ExportedRig exported(const Experiment& experiment) {
  ExportedRig rig;
  rig.rig = experiment.rig;
  rig.values = experiment.values;
  return rig;
}

RigInputs inputs_of(double drive, double supply_pressure_pa, double tank_pressure_pa = 0.0) {
  RigInputs inputs;
  inputs.drive.value = drive;
  inputs.supply_pressure_pa.value = supply_pressure_pa;
  inputs.tank_pressure_pa.value = tank_pressure_pa;
  return inputs;
}

std::vector<std::string> names(const ExportedRig& rig) {
  std::vector<std::string> names;
  for (const StateDescription& state : describe_states(rig, make_equations(rig)->layout()))
    names.push_back(state.name);
  return names;
}

}  // namespace

TEST_CASE("equations: every state has a name and a size", "[model]") {
  const ExportedRig rig = rig_with(
      {"valve_frequency", "valve_damping_ratio", "ki", "kd", "derivative_filter", "sample_time"});
  const std::vector<std::string> all = names(rig);
  CHECK(all == std::vector<std::string>{"position", "velocity", "load_pressure", "valve_signal",
                                        "valve_signal_rate", "controller_integral",
                                        "controller_filtered_error", "controller_held_output"});
  for (const StateDescription& state : describe_states(rig, make_equations(rig)->layout()))
    CHECK(state.nominal > 0.0);
}

TEST_CASE("equations: states of a second mass, and the filter of a loop on force", "[model]") {
  ExportedRig rig = rig_with({"payload_mass", "payload_frequency", "payload_damping_ratio",
                              "force_kp", "force_kd", "derivative_filter"});
  rig.rig.feedback = Feedback::force;
  CHECK(names(rig) == std::vector<std::string>{"position", "velocity", "load_pressure",
                                               "payload_position", "payload_velocity",
                                               "controller_filtered_error"});
  const auto states = describe_states(rig, make_equations(rig)->layout());
  CHECK(states.back().unit == "N");
  CHECK(states[2].nominal == Approx(0.1 * rig.values["supply_pressure"]));
}

TEST_CASE("equations: a shake table moves as it is simulated", "[model]") {
  for (const Feedback feedback :
       {Feedback::three_variable, Feedback::three_variable_acceleration}) {
    const double drive = feedback == Feedback::three_variable ? 0.004 : 10.0;
    Experiment e;
    e.rig.feedback = feedback;
    e.set("kp", 200.0).set("ki", 100.0).set("velocity_kp", 2.0).set("acceleration_kp", 3e-3);
    e.set("reference_frequency", 60.0).set("reference_damping_ratio", 0.7);
    e.set("valve_time_constant", 2e-3);
    e.inputs.drive = Signal::constant(drive);
    e.times_s = {0.0, 0.05};
    e.options.tolerance = 1e-10;
    e.outputs = {Output::position, Output::command};
    const Simulation run = e();
    INFO(run.reason);
    REQUIRE(run.ok());
    const ExportedRig rig = exported(e);
    CHECK(names(rig) == std::vector<std::string>{"position", "velocity", "load_pressure",
                                                 "valve_signal", "controller_integral",
                                                 "controller_filtered_reference",
                                                 "controller_filtered_rate"});
    const auto equations = make_equations(rig);
    equations->set(rig.values, inputs_of(drive, rig.values["supply_pressure"]), 1.0);
    std::vector<double> x = equations->initial();
    StepMemory memory;
    equations->advance(x, memory, 0.0, 0.05, 1e-10);
    REQUIRE(std::abs(x[0]) > 1e-4);
    CHECK(x[0] == Approx(run.outputs(1, 0)).epsilon(1e-6));
    CHECK(equations->output(Output::command, x) == Approx(run.outputs(1, 1)).epsilon(1e-6));
  }
}

TEST_CASE("equations: an indicator is zero where the controller reaches its limit", "[model]") {
  ExportedRig rig = rig_with({});
  rig.values.set("kp", 100.0);
  rig.values.set("output_limit", 2.0);
  const auto equations = make_equations(rig);
  const auto indicators_at = [&](double reference_m) {
    equations->set(rig.values, inputs_of(reference_m, 6e6), 1.0);
    return equations->indicators(std::vector<double>(3, 0.0));
  };
  const auto inside = indicators_at(0.019);
  const auto outside = indicators_at(0.021);
  REQUIRE(inside.size() == 3);  // the sign of the spool, and both limits
  CHECK(inside[0] == Approx(1.9));
  CHECK(inside[1] == Approx(0.1));
  CHECK(outside[1] == Approx(-0.1));
  CHECK(outside[2] == Approx(4.1));
}

TEST_CASE("equations: a ramp of the input is followed, not held", "[model]") {
  // With an open valve and no leak, the speed of the piston is proportional to the command. A
  // one-second ramp therefore moves it half as far as its end value would.
  ExportedRig rig = rig_with({});
  rig.rig.controller = ControllerKind::none;
  rig.values.set("leakage_coefficient", 0.0);
  const auto equations = make_equations(rig);
  const auto travel = [&](const Ramp& command) {
    RigInputs inputs;
    inputs.drive = command;
    inputs.supply_pressure_pa.value = rig.values["supply_pressure"];
    equations->set(rig.values, inputs, 1.0);
    std::vector<double> x = equations->initial();
    StepMemory memory;
    equations->advance(x, memory, 0.0, 1.0, 1e-8);
    return x[0];
  };
  CHECK(travel({0.0, 0.01}) == Approx(0.5 * travel({0.01, 0.0})).epsilon(0.02));
}

TEST_CASE("equations: a two-stage valve moves as it is simulated, with the limit of its pilot",
          "[model]") {
  Experiment e;
  e.rig.controller = ControllerKind::none;
  e.set("valve_time_constant", 2e-3).set("main_spool_gain", 200.0).set("valve_rate_limit", 60.0);
  e.inputs.drive = Signal::constant(0.5);
  e.times_s = {0.0, 0.012};
  e.options.tolerance = 1e-10;
  e.outputs = {Output::position, Output::load_pressure, Output::spool};
  const Simulation run = e();
  REQUIRE(run.ok());
  const ExportedRig rig = exported(e);
  CHECK(names(rig) == std::vector<std::string>{"position", "velocity", "load_pressure",
                                               "valve_signal", "pilot_opening"});
  const auto equations = make_equations(rig);
  equations->set(rig.values, inputs_of(0.5, rig.values["supply_pressure"]), 1.0);
  std::vector<double> x = equations->initial();
  // The pilot is fully open until 0.3 V are missing: 60 V/s at 200 1/s.
  const std::vector<double> before = equations->indicators(x);
  REQUIRE(before.size() == 3);
  CHECK(before[1] == Approx(60.0 - 0.5 * 200.0));
  StepMemory memory;
  equations->advance(x, memory, 0.0, 0.012, 1e-10);
  CHECK(x[0] == Approx(run.outputs(1, 0)).epsilon(1e-6));
  CHECK(x[3] * rig.values["valve_gain"] == Approx(run.outputs(1, 2)).epsilon(1e-7));
  CHECK(equations->indicators(x)[1] == Approx(60.0 - (0.5 - x[3]) * 200.0));
  CHECK(equations->indicators(x)[1] > 0.0);
}

TEST_CASE("equations: an arm moves as it is simulated, and its kinks have indicators", "[model]") {
  Experiment e = arm_rig();
  e.set("valve_time_constant", 0.03).set("supply_resistance", 1e9).set("supply_capacity", 1e-11);
  e.set("pump_flow", 6e-4).set("pump_second_flow", 9e-4).set("pump_delay", 0.3);
  e.set("make_up_conductance", 1e-8).set("bypass_opening", 1e-4).set("bypass_range", 2.5e6);
  e.inputs.drive = Signal::constant(3e6);
  e.times_s = {0.0, 0.5};
  e.options.tolerance = 1e-9;
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  const ExportedRig rig = exported(e);
  CHECK(names(rig) == std::vector<std::string>{"angle", "angular_velocity", "pressure_a",
                                               "pressure_b", "valve_supply_pressure", "pump_demand",
                                               "valve_signal"});
  const auto equations = make_equations(rig);
  CHECK(describe_states(rig, equations->layout()).back().unit == "Pa");
  equations->set(rig.values, inputs_of(3e6, 2e7, 2e5), 1.0);
  std::vector<double> x = equations->initial();
  StepMemory memory;
  equations->advance(x, memory, 0.0, 0.5, 1e-9);
  REQUIRE(std::abs(run.outputs(1, 0)) > 0.05);
  CHECK(x[0] == Approx(run.outputs(1, 0)).epsilon(1e-6));
  CHECK(x[1] == Approx(run.outputs(1, 1)).epsilon(1e-5));
  CHECK(equations->output(Output::pilot_pressure, x) == 3e6);
  // One indicator each for both directions of the spool, both directions of its bypass, both stops,
  // both make-up valves, and the limit of the pump.
  const std::vector<double> indicators = equations->indicators(x);
  REQUIRE(indicators.size() == 9);
  CHECK(indicators[0] == Approx(x[6] - 1e6));
  CHECK(indicators[4] == Approx(1e6 + 2.5e6 - x[6]));
  CHECK(indicators[3] == Approx(1.0 - x[0]));
}

TEST_CASE("equations: an arm on a triangle, and one with a table, move as they are simulated",
          "[model]") {
  struct Row {
    NamedValues travel;
    std::size_t indicators;  ///< both directions of the spool, both stops, corners of the lever
  };
  for (const Row& row :
       {Row{{{"triangle_base", 1.2}, {"triangle_arm", 0.35}, {"triangle_angle", 1.3}}, 4},
        Row{{{"travel_table_from", -1.2},
             {"travel_table_to", 1.3},
             {"travel_0", 0.0},
             {"travel_20", 0.10},
             {"travel_40", 0.24},
             {"travel_60", 0.40},
             {"travel_80", 0.52},
             {"travel_100", 0.61}},
            9}}) {
    Experiment e = arm_rig().unset("lever");
    for (const auto& [key, value] : row.travel) e.set(key, value);
    e.inputs.drive = Signal::constant(1.3e6);
    e.times_s = {0.0, 0.4};
    e.outputs = {Output::angle, Output::position, Output::acceleration, Output::torque};
    e.options.tolerance = 1e-10;
    const Simulation run = e();
    INFO(run.reason);
    REQUIRE(run.ok());
    const ExportedRig rig = exported(e);
    const auto equations = make_equations(rig);
    equations->set(rig.values, inputs_of(1.3e6, 2e7, 2e5), 1.0);
    std::vector<double> x = equations->initial();
    StepMemory memory;
    equations->advance(x, memory, 0.0, 0.4, 1e-10);
    REQUIRE(run.outputs(1, 0) > 0.02);
    CHECK(x[0] == Approx(run.outputs(1, 0)).epsilon(1e-6));
    CHECK(equations->output(Output::position, x) == Approx(run.outputs(1, 1)).epsilon(1e-6));
    CHECK(equations->output(Output::torque, x) == Approx(run.outputs(1, 3)).epsilon(1e-5));
    const std::vector<double> indicators = equations->indicators(x);
    REQUIRE(indicators.size() == row.indicators);
    if (indicators.size() == 9) CHECK(indicators[6] == Approx(x[0] - 0.05));
  }
}

TEST_CASE("equations: an arm follows the reference of its loop as it is simulated", "[model]") {
  struct Row {
    Feedback feedback;
    double reference;
    double limit_v;
    NamedValues gains;
    std::size_t states;
  };
  for (const Row& row :
       {Row{Feedback::angle,
            0.4,
            2.0,
            {{"angle_kp", 10.0}, {"angle_ki", 8.0}, {"angle_kd", 0.2}, {"pressure_feedback", 2e-8}},
            6},
        Row{Feedback::angle,
            0.4,
            2.0,
            {{"angle_kp", 10.0},
             {"angular_velocity_feedforward", 0.5},
             {"angular_acceleration_feedforward", 0.01}},
            6},
        Row{Feedback::torque,
            8e3,
            0.5,
            {{"torque_kp", 1e-4},
             {"torque_ki", 5e-4},
             {"torque_kd", 1e-6},
             {"joint_friction", 400}},
            6},
        Row{Feedback::load_pressure,
            4e6,
            0.5,
            {{"load_pressure_kp", 1e-7}, {"load_pressure_ki", 3e-7}, {"load_pressure_kd", 1e-9}},
            6}}) {
    CAPTURE(gain_keys(row.feedback).name, row.gains.back().first);
    Experiment e = arm_rig().unset("pilot_gain").unset("pilot_dead_band");
    e.rig.pilot = false;
    e.rig.controller = ControllerKind::pid;
    e.rig.feedback = row.feedback;
    e.set("valve_gain", 2e-4).set("joint_damping", 1e4).set("gravity_moment_gradient", 2e4);
    e.set("derivative_filter", 100.0).set("output_limit", row.limit_v);
    for (const auto& [key, value] : row.gains) e.set(key, value);
    e.inputs.drive = Signal::constant(row.reference);
    e.times_s = {0.0, 0.7};
    e.outputs = {Output::angle, Output::command, Output::torque, Output::load_pressure};
    e.options.tolerance = 1e-10;
    const Simulation run = e();
    INFO(run.reason);
    REQUIRE(run.ok());
    const ExportedRig rig = exported(e);
    const auto equations = make_equations(rig);
    equations->set(rig.values, inputs_of(row.reference, 2e7, 2e5), 1.0);
    std::vector<double> x = equations->initial();
    REQUIRE(x.size() == row.states);
    CHECK(equations->output(Output::command, x) == row.limit_v);
    StepMemory memory;
    equations->advance(x, memory, 0.0, 0.7, 1e-10);
    REQUIRE(run.outputs(1, 0) > 0.1);
    CHECK(x[0] == Approx(run.outputs(1, 0)).epsilon(1e-6));
    CHECK(equations->output(Output::command, x) == Approx(run.outputs(1, 1)).epsilon(1e-5));
    CHECK(equations->output(Output::torque, x) == Approx(run.outputs(1, 2)).epsilon(1e-5));
    CHECK(equations->output(Output::load_pressure, x) == Approx(run.outputs(1, 3)).epsilon(1e-5));
  }
}

TEST_CASE("equations: an external moment loads a joint, from its first pressures on", "[model]") {
  Experiment e = arm_rig();
  e.set("gravity_moment", 1e3).inputs.external_load = Signal::constant(4e3);
  e.times_s = {0.0, 0.3};
  e.outputs = {Output::angle, Output::pressure_a, Output::torque};
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  ExportedRig rig;
  rig.rig = e.rig;
  rig.values = e.values;
  const auto equations = make_equations(rig);
  RigInputs inputs;
  inputs.drive.value = 1.5e6;
  inputs.external_load.value = 4e3;
  inputs.supply_pressure_pa.value = 2e7;
  inputs.tank_pressure_pa.value = 2e5;
  equations->set(rig.values, inputs, 1.0);
  std::vector<double> x = equations->initial();
  CHECK(x[2] == Approx(run.outputs(0, 1)).epsilon(1e-9));
  CHECK(equations->output(Output::torque, x) == Approx(5e3).epsilon(1e-6));
  const double at_rest = equations->derivatives(x)[1];
  CHECK(at_rest == Approx(0.0).margin(1e-6));
  StepMemory memory;
  equations->advance(x, memory, 0.0, 0.3, 1e-9);
  REQUIRE(run.outputs(1, 0) > 1e-3);
  CHECK(x[0] == Approx(run.outputs(1, 0)).epsilon(1e-6));
  inputs.external_load.value = 4.4e3;
  equations->set(rig.values, inputs, 1.0);
  const double pushed = equations->derivatives(x)[1];
  inputs.external_load.value = 4e3;
  equations->set(rig.values, inputs, 1.0);
  CHECK(pushed - equations->derivatives(x)[1] == Approx(-400.0 / 400.0).epsilon(1e-9));
}

TEST_CASE("equations: a cylinder with a load-sensing pump and friction with pre-sliding",
          "[model]") {
  Experiment e = pilot_rig();
  e.set("pilot_gain", 1e-10).set("compensator_pressure", 8e5).set("load_sensing_margin", 2e6);
  e.set("supply_resistance", 1e9).set("supply_capacity", 1e-11).set("accumulator_volume", 1e-4);
  e.set("accumulator_precharge", 1e6).set("relief_pressure", 1.5e7);
  e.set("relief_conductance", 1e-10).set("coulomb_friction", 2e3).set("bristle_stiffness", 1e7);
  e.set("stribeck_friction", 1e3).set("film_velocity", 0.1).set("film_growth_time", 0.05);
  e.set("film_decay_time", 0.2).set("film_dwell_time", 5.0).set("seal_friction", 1e-5);
  e.set("external_force", 0.0).inputs.external_load = Signal::constant(1e4);
  e.times_s = {0.0, 0.5};
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  const ExportedRig rig = exported(e);
  CHECK(names(rig) == std::vector<std::string>{"position", "velocity", "pressure_a", "pressure_b",
                                               "valve_supply_pressure", "bristle_force",
                                               "film_thickness"});
  const auto equations = make_equations(rig);
  CHECK(describe_states(rig, equations->layout())[5].unit == "N");
  RigInputs inputs = inputs_of(2e6, 2e7, 2e5);
  inputs.external_load.value = 1e4;
  equations->set(rig.values, inputs, 1.0);
  std::vector<double> x = equations->initial();
  StepMemory memory;
  equations->advance(x, memory, 0.0, 0.5, 1e-9);
  REQUIRE(run.outputs(1, 0) > 1e-3);
  CHECK(x[0] == Approx(run.outputs(1, 0)).epsilon(1e-6));
  CHECK(x[2] == Approx(run.outputs(1, 2)).epsilon(1e-5));
  CHECK(equations->output(Output::pilot_pressure, x) == 2e6);
  CHECK(equations->output(Output::command, x) == 0.0);
  // One indicator each for four edges, both stops, compensators on both sides, both relief valves,
  // the pressure limit of the pump, the seals, the reversal of the bristles, and the growth of the
  // film.
  const std::vector<double> indicators = equations->indicators(x);
  REQUIRE(indicators.size() == 14);
  CHECK(indicators[0] == Approx(1e6));
  CHECK(indicators[6] == Approx(x[4] - x[2] - 8e5));
  CHECK(indicators[8] == Approx(1.5e7 - x[2]));
  CHECK(indicators[10] == Approx(2e5 + 2e6 + (x[2] - 2e5) - 2e7));
  CHECK(indicators[11] == Approx(x[2] - x[3]));
  CHECK(indicators[12] == Approx(x[1]));
  CHECK(indicators[13] == Approx(steady_film(x[1], 0.1, 1e-3) - x[6]).margin(1e-12));
}

TEST_CASE("equations: an arm whose cylinder rubs moves as it is simulated", "[model]") {
  Experiment e = arm_rig();
  e.set("lever_gradient", -0.1).set("coulomb_friction", 2e3).set("stribeck_friction", 1e3);
  e.set("seal_friction", 1e-4).set("bristle_stiffness", 1e7).set("film_velocity", 0.1);
  e.set("film_growth_time", 0.05).set("film_decay_time", 0.2).set("film_dwell_time", 5.0);
  e.inputs.drive = Signal::constant(2e6);
  e.times_s = {0.0, 0.3};
  e.outputs = {Output::angle, Output::pressure_a, Output::force, Output::torque};
  e.options.tolerance = 1e-8;
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  const ExportedRig rig = exported(e);
  CHECK(names(rig) == std::vector<std::string>{"angle", "angular_velocity", "pressure_a",
                                               "pressure_b", "bristle_force", "film_thickness"});
  const auto equations = make_equations(rig);
  equations->set(rig.values, inputs_of(2e6, 2e7, 2e5), 1.0);
  std::vector<double> x = equations->initial();
  StepMemory memory;
  equations->advance(x, memory, 0.0, 0.3, 1e-8);
  REQUIRE(run.outputs(1, 0) > 0.02);
  CHECK(x[0] == Approx(run.outputs(1, 0)).epsilon(1e-5));
  CHECK(x[2] == Approx(run.outputs(1, 1)).epsilon(1e-5));
  CHECK(equations->output(Output::force, x) == Approx(run.outputs(1, 2)).epsilon(1e-5));
  CHECK(equations->output(Output::torque, x) == Approx(run.outputs(1, 3)).epsilon(1e-5));
  // Both directions of the spool, both stops, the seals, the reversal of the piston, and the growth
  // of its film.
  const std::vector<double> indicators = equations->indicators(x);
  REQUIRE(indicators.size() == 7);
  const double v = (0.3 - 0.1 * x[0]) * x[1];
  CHECK(indicators[4] == Approx(x[2] - x[3]));
  CHECK(indicators[5] == Approx(v));
  CHECK(indicators[6] == Approx(steady_film(v, 0.1, 1e-3) - x[5]).margin(1e-12));
}

TEST_CASE("equations: a load-pressure rig has a supply that gives way as it is simulated",
          "[model]") {
  Experiment e;
  e.rig.controller = ControllerKind::none;
  e.set("supply_resistance", 1e10).set("supply_capacity", 1e-13).set("pump_flow", 7e-5);
  e.set("accumulator_volume", 1e-6).set("accumulator_precharge", 3e6);
  e.set("relief_pressure", 4e6).set("relief_conductance", 1e-11);
  e.inputs.drive = Signal::constant(2.0);
  e.times_s = {0.0, 0.1};
  e.options.tolerance = 1e-10;
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  const ExportedRig rig = exported(e);
  CHECK(names(rig) ==
        std::vector<std::string>{"position", "velocity", "load_pressure", "valve_supply_pressure"});
  const auto equations = make_equations(rig);
  equations->set(rig.values, inputs_of(2.0, 6.2e6), 1.0);
  std::vector<double> x = equations->initial();
  CHECK(x[3] == 6.2e6);
  StepMemory memory;
  equations->advance(x, memory, 0.0, 0.1, 1e-10);
  REQUIRE(run.outputs(1, 0) > 1e-3);
  CHECK(x[0] == Approx(run.outputs(1, 0)).epsilon(1e-6));
  CHECK(x[2] == Approx(run.outputs(1, 1)).epsilon(1e-5));
  // One indicator each for the sign of the spool, both relief valves and the limit of the pump.
  const std::vector<double> indicators = equations->indicators(x);
  REQUIRE(indicators.size() == 4);
  CHECK(indicators[1] == Approx(4e6 - 0.5 * (x[3] + x[2])));
  CHECK(indicators[2] == Approx(4e6 - 0.5 * (x[3] - x[2])));
  CHECK(indicators[3] == Approx(7e-5 - (6.2e6 - x[3]) / 1e10));
}

TEST_CASE("equations: a step that was planned at rest is repeated when the drive jumps",
          "[model]") {
  const ExportedRig rig = rig_with({});
  const auto equations = make_equations(rig);
  RigInputs inputs;
  inputs.supply_pressure_pa.value = rig.values["supply_pressure"];
  equations->set(rig.values, inputs, 1.0);
  const std::vector<double> rest = equations->initial();
  inputs.drive.value = 0.01;
  equations->set(rig.values, inputs, 1.0);
  for (const double length_s : {2e-4, 2.5e-4, 3e-4}) {
    const auto moved = [&](double planned_step_s, double tolerance) {
      std::vector<double> x = rest;
      StepMemory memory;
      memory.planned_step_s = planned_step_s;
      equations->advance(x, memory, 0.0, length_s, tolerance);
      return x;
    };
    const std::vector<double> exact = moved(1e-6, 1e-10);
    const std::vector<double> coarse = moved(length_s, 1e-3);
    // A single step would miss the tolerance by a factor of two.
    for (std::size_t i = 0; i < 3; ++i) {
      CAPTURE(length_s, i);
      CHECK(coarse[i] == Approx(exact[i]).epsilon(1e-3));
    }
  }
}

TEST_CASE("equations: states that leave the numbers are an error", "[model]") {
  const ExportedRig rig = rig_with({});
  const auto equations = make_equations(rig);
  RigInputs inputs;
  inputs.supply_pressure_pa.value = 6e6;
  equations->set(rig.values, inputs, 1.0);
  std::vector<double> x{0.0, 1e300, 0.0};
  StepMemory memory;
  CHECK_THROWS_WITH(equations->advance(x, memory, 0.0, 1.0, 1e-6),
                    Catch::Contains("the solver fails at steps of"));
}
