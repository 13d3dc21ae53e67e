// Tests the cylinder on a lever: against the plant with a sliding load, in steady motion, and term
// by term against closed forms (docs/model.md, sections 9 and 10).

#include "model/plant/linkage.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/model/linkage_rig.hpp"
#include "tests/model/sensitivity.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

/// Outputs at the last sample, in the order of e.outputs.
Eigen::RowVectorXd last_of_arm(const Experiment& e) {
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  return run.outputs.row(run.outputs.rows() - 1);
}

double quadratic_of(double x, double c0, double c1, double c2) { return c0 + (c1 + c2 * x) * x; }

/// Flow through an open edge of arm_rig() [m3/s].
double spool_edge_flow(double opening_m, double head_pa) {
  return 0.65 * 0.02 * opening_m * std::sqrt(2.0 * head_pa / 870.0);
}

}  // namespace

TEST_CASE("linkage: with a constant lever it is the cylinder that slides", "[model]") {
  constexpr double kLever = 0.25;
  const NamedValues coulomb{{"coulomb_friction", 20.0}, {"friction_smoothing", 0.01}};
  const NamedValues seals{
      {"coulomb_friction", 20.0},  {"friction_smoothing", 0.01}, {"stribeck_friction", 15.0},
      {"stribeck_velocity", 0.05}, {"seal_friction", 1e-5},      {"bristle_stiffness", 1e5},
      {"bristle_damping", 100.0},  {"film_velocity", 0.08},      {"film_growth_time", 0.02},
      {"film_decay_time", 0.06},   {"film_dwell_time", 0.5}};
  const bool of_joint = GENERATE(true, false);
  Experiment sliding = single_rod_rig();
  for (const auto& [key, value] : of_joint ? coulomb : seals) sliding.set(key, value);
  sliding.set("stop_stiffness", 2e6).set("stop_damping", 20.0).set("external_force", 60.0);
  sliding.set("valve_time_constant", 5e-3).set("supply_resistance", 2e10);
  sliding.set("supply_capacity", 5e-12).set("air_fraction", 0.01);
  sliding.set("external_leakage_a", 2e-13).set("valve_null_leakage", 1e-13);
  sliding.set("leakage_coefficient", 0.02).set("valve_dead_band", 0.1).set("valve_offset", 0.05);
  sliding.set("gain_b_to_tank", 1.3);
  sliding.inputs.drive = Signal::square(8.0, 0.25);  // from stop to stop
  sliding.times_s = grid(0.0, 5.0, 501);
  sliding.options.tolerance = 1e-9;
  Experiment turning = sliding;
  turning.rig.plant = PlantKind::linkage;
  turning.values = ParameterValues::defaults(PlantKind::linkage);
  const auto table = parameter_table(PlantKind::two_chamber);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const int index = parameter_index(PlantKind::linkage, table[i].key);
    if (sliding.values.given[i] && index >= 0) turning.values.set(index, sliding.values.value[i]);
  }
  turning.set("lever", kLever).set("inertia", 5.0 * kLever * kLever);
  turning.set("joint_damping", 200.0 * kLever * kLever).set("gravity_moment", 60.0 * kLever);
  if (of_joint) {
    turning.unset("coulomb_friction").unset("friction_smoothing");
    turning.set("joint_friction", 20.0 * kLever).set("joint_friction_smoothing", 0.01 / kLever);
  }
  turning.set("lower_stop", -0.1 / kLever).set("upper_stop", 0.1 / kLever);
  turning.set("stop_stiffness", 2e6 * kLever * kLever).set("stop_damping", 20.0 * kLever);
  sliding.outputs = {Output::position,   Output::velocity,      Output::pressure_a,
                     Output::pressure_b, Output::load_pressure, Output::servo_flow,
                     Output::work_flow,  Output::leakage_flow,  Output::acceleration};
  turning.outputs = sliding.outputs;
  turning.outputs.push_back(Output::angle);
  turning.outputs.push_back(Output::angular_velocity);
  turning.outputs.push_back(Output::torque);
  sliding.outputs.push_back(Output::force);
  const Simulation slid = sliding();
  const Simulation turned = turning();
  REQUIRE(slid.ok());
  REQUIRE(turned.ok());
  REQUIRE(slid.outputs.col(0).maxCoeff() > 0.1);  // it reaches both stops
  REQUIRE(slid.outputs.col(0).minCoeff() < -0.1);
  CHECK(difference(slid.outputs.leftCols(9), turned.outputs.leftCols(9)) < 2e-5);
  CHECK(peak(turned.outputs.col(9) * kLever - turned.outputs.col(0)) < 1e-12);
  CHECK(peak(turned.outputs.col(10) * kLever - turned.outputs.col(1)) < 1e-12);
  // A load cell in the rod reads what a torque transducer at the joint reads, less dry friction and
  // with the stops.
  CHECK(difference(slid.outputs.col(9) * kLever, turned.outputs.col(11)) < 2e-5);
}

TEST_CASE("linkage: two methods agree on an arm with all of its terms", "[model]") {
  Experiment e = arm_rig();
  e.set("lever_gradient", 0.05).set("lever_curvature", -0.08).set("gravity_moment", 6e3);
  e.set("gravity_moment_gradient", 2e3).set("gravity_moment_curvature", -1e3);
  e.set("pilot_exponent", 1.7).set("pilot_range", 1e6).set("valve_time_constant", 0.03);
  e.set("supply_resistance", 1e9).set("supply_capacity", 1e-11).set("pump_flow", 6e-4);
  e.set("pump_second_flow", 9e-4).set("pump_delay", 0.5).set("pump_rise", 0.05);
  e.set("make_up_conductance", 1e-8).set("joint_friction", 100.0);
  e.set("return_line_resistance", 1e9).set("bypass_opening", 2e-4).set("bypass_range", 1.2e6);
  e.inputs.drive = Signal::sine(2.5e6, 0.5);
  e.times_s = grid(0.0, 2.0, 101);
  e.outputs = {Output::angle, Output::pressure_a, Output::pressure_b, Output::servo_flow};
  e.options.tolerance = 1e-9;
  e.options.method = Method::rosenbrock;
  const Simulation implicit = e();
  e.options.method = Method::dopri5;
  const Simulation explicit_run = e();
  REQUIRE(implicit.ok());
  REQUIRE(explicit_run.ok());
  REQUIRE(peak(implicit.outputs.col(0)) > 0.1);
  CHECK(difference(implicit.outputs, explicit_run.outputs) < 1e-5);
}

TEST_CASE("linkage: at rest the piston holds the moment of the load at its angle", "[model]") {
  for (const double theta : {-0.7, 0.0, 0.6}) {
    Experiment e = arm_rig();
    e.rig.initial = InitialState::given;
    e.inputs.drive = Signal::constant(0.0);
    e.set("reference_angle", 0.2).set("lever_gradient", 0.06).set("lever_curvature", -0.1);
    e.set("gravity_moment", 5e3).set("gravity_moment_gradient", -8e3);
    e.set("gravity_moment_curvature", 4e3).set("initial_angle", theta);
    e.outputs = {Output::angle, Output::pressure_a, Output::pressure_b, Output::force,
                 Output::position};
    const auto end = last_of_arm(e);
    const double lever = quadratic_of(theta - 0.2, 0.3, 0.06, -0.1);
    const double moment = quadratic_of(theta - 0.2, 5e3, -8e3, 4e3);
    CAPTURE(theta, moment);
    CHECK_THAT(end(0), WithinAbs(theta, 1e-7));
    CHECK_THAT(lever * (4e-3 * end(1) - 2.4e-3 * end(2)), WithinAbs(moment, 0.1));
    CHECK_THAT(end(3), WithinRel(moment / lever, 1e-4));
    CHECK_THAT(end(1) + end(2), WithinRel(2e7 + 2e5, 1e-5));
    // The travel is the integral of the lever.
    const double from = theta - 0.2;
    CHECK_THAT(end(4), WithinAbs(from * (0.3 + from * (0.03 - from * 0.1 / 3.0)), 1e-7));
  }
}

TEST_CASE("linkage: in steady motion the flows are those of the edges", "[model]") {
  Experiment e = arm_rig();
  // Slow enough to be steady, with damping of the order of the pressure forces.
  e.set("joint_damping", 4e4).set("gain_b_to_tank", 0.7).set("pilot_gain", 1e-11);
  e.set("lower_stop", -2.0).set("upper_stop", 2.0);
  e.inputs.drive = Signal::constant(2e6);
  e.times_s = {0.0, 60.0};
  e.options.tolerance = 1e-9;
  e.outputs = {Output::angular_velocity, Output::pressure_a, Output::pressure_b, Output::spool,
               Output::pilot_pressure,   Output::command};
  const auto end = last_of_arm(e);
  const double opening_m = 1e-11 * 1e6;  // the dead band is 1 MPa
  CHECK_THAT(end(3), WithinRel(opening_m, 1e-12));
  CHECK(end(4) == 2e6);
  CHECK(end(5) == 0.0);  // no voltage
  CHECK(end(0) > 1e-3);
  CHECK_THAT(spool_edge_flow(opening_m, 2e7 - end(1)), WithinRel(4e-3 * 0.3 * end(0), 1e-4));
  CHECK_THAT(0.7 * spool_edge_flow(opening_m, end(2) - 2e5),
             WithinRel(2.4e-3 * 0.3 * end(0), 1e-4));
  CHECK_THAT(0.3 * (4e-3 * end(1) - 2.4e-3 * end(2)), WithinRel(4e4 * end(0), 1e-4));
}

TEST_CASE("linkage: the line to the tank loses in proportion to its flow", "[model]") {
  for (const double sign : {1.0, -1.0}) {
    Experiment e = arm_rig();
    e.set("joint_damping", 4e4).set("pilot_gain", 1e-11).set("return_line_resistance", 2e11);
    e.set("gain_b_to_tank", 0.7).set("gain_a_to_tank", 0.6);
    e.set("lower_stop", -2.0).set("upper_stop", 2.0);
    e.inputs.drive = Signal::constant(sign * 2e6);
    e.times_s = {0.0, 60.0};
    e.options.tolerance = 1e-9;
    e.outputs = {Output::angular_velocity, Output::pressure_a, Output::pressure_b};
    const auto end = last_of_arm(e);
    const bool out = sign > 0.0;
    const double flow = (out ? 2.4e-3 : 4e-3) * 0.3 * std::abs(end(0));
    const double port_pa = 2e5 + 2e11 * flow;
    REQUIRE(port_pa > 1e6);
    CHECK_THAT((out ? 0.7 : 0.6) * spool_edge_flow(1e-5, end(out ? 2 : 1) - port_pa),
               WithinRel(flow, 1e-4));
  }
}

TEST_CASE("linkage: through an open centre the pump's pressure follows the spool", "[model]") {
  Experiment e = arm_rig();
  e.set("supply_resistance", 1e9).set("supply_capacity", 1e-12).set("pump_flow", 5e-4);
  e.set("bypass_opening", 4e-4).set("bypass_range", 2e6);
  e.times_s = {0.0, 20.0};
  e.outputs = {Output::pressure_a};
  // At the stop, all flow of the pump takes the bypass, as long as the pressure limit is not
  // reached.
  for (const double beyond_pa : {4e5, 8e5}) {
    e.inputs.drive = Signal::constant(1e6 + beyond_pa);
    const double a_pa = last_of_arm(e)(0);
    REQUIRE(a_pa < 1.9e7);
    CHECK_THAT(spool_edge_flow(4e-4 * (1.0 - beyond_pa / 2e6), a_pa - 2e5), WithinRel(5e-4, 1e-4));
  }
  e.inputs.drive = Signal::constant(3.1e6);  // the bypass is closed
  CHECK_THAT(last_of_arm(e)(0), WithinRel(2e7, 1e-4));
  // In the other direction it opens equally far.
  e.set("bypass_opening", 5e-4).set("upper_stop", 2.0);
  e.outputs = {Output::pressure_b};
  e.inputs.drive = Signal::constant(-1.4e6);
  CHECK_THAT(spool_edge_flow(5e-4 * 0.8, last_of_arm(e)(0) - 2e5), WithinRel(5e-4, 1e-4));
}

TEST_CASE("linkage: the spool opens by a power of the pilot pressure, both ways alike", "[model]") {
  Experiment e = arm_rig();
  e.set("pilot_exponent", 2.5).set("pilot_range", 8e5);
  e.outputs = {Output::spool};
  for (const double beyond_pa : {1e5, 4e5, 8e5, 2e6}) {
    for (const double sign : {1.0, -1.0}) {
      e.inputs.drive = Signal::constant(sign * (1e6 + beyond_pa));
      const double expected = 5e-10 * 8e5 * std::pow(beyond_pa / 8e5, 2.5);
      CHECK_THAT(last_of_arm(e)(0), WithinRel(sign * expected, 1e-12));
    }
  }
  e.inputs.drive = Signal::constant(0.99e6);
  CHECK(last_of_arm(e)(0) == 0.0);
}

TEST_CASE("linkage: a pump gives its first flow, then its second", "[model]") {
  Experiment e = arm_rig();
  e.set("lower_stop", -2.0).set("upper_stop", 20.0).set("supply_resistance", 1e9);
  e.set("dead_volume_a", 1e-5).set("bulk_modulus", 8e9).set("joint_damping", 2e4);
  e.set("supply_capacity", 1e-12).set("pump_flow", 2e-4).set("pump_second_flow", 3e-4);
  e.set("pump_delay", 4.0).set("pump_rise", 0.2);
  e.inputs.drive = Signal::constant(4e6);
  e.times_s = {0.0, 2.5, 4.0, 8.0};
  e.options.tolerance = 1e-8;
  const Simulation run = e();
  REQUIRE(run.ok());
  const double volume_per_rad = 4e-3 * 0.3;
  CHECK_THAT(run.outputs(1, 1), WithinRel(2e-4 / volume_per_rad, 1e-4));
  CHECK_THAT(run.outputs(2, 1), WithinRel(2.5e-4 / volume_per_rad, 5e-2));  // in the middle
  CHECK_THAT(run.outputs(3, 1), WithinRel(3e-4 / volume_per_rad, 1e-4));
  // The demand time decays while the valve is closed.
  e.inputs.drive =
      Signal::linear({0.0, 7.99, 8.0, 40.0, 40.01, 42.0}, {4e6, 4e6, 0.0, 0.0, 4e6, 4e6});
  e.times_s = {0.0, 7.9, 41.5};
  const Simulation again = e();
  REQUIRE(again.ok());
  CHECK_THAT(again.outputs(1, 1), WithinRel(3e-4 / volume_per_rad, 1e-4));
  CHECK_THAT(again.outputs(2, 1), WithinRel(2e-4 / volume_per_rad, 1e-4));
}

TEST_CASE("linkage: at its stop the chamber fills to the pressure that the pump is limited to",
          "[model]") {
  Experiment e = arm_rig();
  e.set("supply_resistance", 1e9).set("supply_capacity", 1e-12).set("pump_flow", 5e-4);
  e.inputs.drive = Signal::constant(3e6);
  e.times_s = {0.0, 20.0};
  e.outputs = {Output::angle, Output::pressure_a, Output::pressure_b};
  const auto end = last_of_arm(e);
  CHECK_THAT(end(1), WithinRel(2e7, 1e-4));
  CHECK_THAT(end(2), WithinRel(2e5, 1e-3));
  // Pressed in by the piston force divided by the stiffness of the stop.
  CHECK_THAT(end(0), WithinAbs(1.0 + 0.3 * (4e-3 * 2e7 - 2.4e-3 * 2e5) / 1e7, 1e-6));
}

TEST_CASE("linkage: the torque balances inertia, viscous friction and load, into a stop too",
          "[model]") {
  Experiment e = arm_rig();
  e.set("joint_friction", 400.0).set("joint_friction_smoothing", 0.02);
  e.set("gravity_moment", 3e3).set("gravity_moment_gradient", 1500.0);
  e.inputs.drive = Signal::constant(3e6);
  e.times_s = grid(0.0, 6.0, 601);
  e.outputs = {Output::angle, Output::angular_velocity, Output::acceleration, Output::torque,
               Output::force};
  e.options.tolerance = 1e-9;
  const Simulation run = e();
  REQUIRE(run.ok());
  REQUIRE(run.outputs(600, 0) > 1.0);  // pressed into the stop
  for (Eigen::Index i = 0; i < run.outputs.rows(); ++i) {
    const double omega = run.outputs(i, 1);
    const double expected =
        400.0 * run.outputs(i, 2) / 0.3 + 500.0 * omega + 3e3 + 1500.0 * run.outputs(i, 0);
    CAPTURE(i);
    CHECK_THAT(run.outputs(i, 3), WithinAbs(expected, 1e-4));
    if (run.outputs(i, 0) < 1.0)
      CHECK_THAT(run.outputs(i, 3),
                 WithinAbs(0.3 * run.outputs(i, 4) - 400.0 * std::tanh(omega / 0.02), 1e-4));
  }
  // The stop takes what the pressures have beyond the load.
  CHECK(0.3 * run.outputs(600, 4) > 5.0 * run.outputs(600, 3));
}

TEST_CASE("linkage: a support holds what the pressures do not", "[model]") {
  Experiment e = arm_rig();
  e.rig.initial = InitialState::given;
  e.inputs.drive = Signal::constant(0.0);
  e.set("gravity_moment", 3e3).set("initial_angle", -1.001);
  e.set("initial_pressure_a", 1e6).set("initial_pressure_b", 2e6);
  const auto end = last_of_arm(e);
  CHECK_THAT(end(0), WithinAbs(-1.0 + (0.3 * (4e-3 * 1e6 - 2.4e-3 * 2e6) - 3e3) / 1e7, 1e-8));
  CHECK_THAT(end(1), WithinAbs(0.0, 1e-7));
}

TEST_CASE("linkage: the tank fills a chamber that the load pulls empty", "[model]") {
  // The load raises the arm while the pump fills chamber A too slowly, so A cavitates.
  Experiment e = arm_rig();
  e.set("lower_stop", -1.0).set("upper_stop", 20.0).set("gravity_moment", -2e3);
  e.set("joint_damping", 4e3).set("gain_supply_to_a", 0.01).set("pilot_gain", 1e-10);
  e.set("gain_b_to_tank", 4.0);
  e.times_s = {0.0, 3.0};
  e.outputs = {Output::angular_velocity, Output::pressure_a};
  const double without_pa = last_of_arm(e)(1);
  e.set("make_up_conductance", 1e-8);
  const auto end = last_of_arm(e);
  CHECK(without_pa < -1e5);
  const double asked = 4e-3 * 0.3 * end(0) - 0.01 * spool_edge_flow(1e-10 * 5e5, 2e7 - end(1));
  REQUIRE(asked > 1e-5);
  CHECK_THAT(2e5 - end(1), WithinRel(asked / 1e-8, 1e-3));
}

TEST_CASE("linkage: sensitivities are exact against differences, every parameter and term",
          "[model]") {
  const auto none = ControllerKind::none;
  const NamedValues joint{{"lever_gradient", 0.05},
                          {"lever_curvature", -0.08},
                          {"reference_angle", 0.02},
                          {"gravity_moment", 6e3},
                          {"gravity_moment_gradient", 2e4},
                          {"gravity_moment_curvature", -3e5},
                          {"joint_friction", 300.0},
                          {"joint_friction_smoothing", 0.2},
                          {"initial_angle", 0.1},
                          {"initial_angular_velocity", 0.3},
                          {"initial_pressure_a", 8e6},
                          {"initial_pressure_b", 5e6},
                          {"angle_gain", 1.1},
                          {"angle_offset", 0.05},
                          {"angle_lag", 4e-3},
                          {"torque_gain", 1.05},
                          {"torque_offset", 200.0},
                          {"torque_lag", 3e-3},
                          {"pressure_a_offset", 2e5},
                          {"pressure_b_offset", -3e5},
                          {"load_pressure_offset", 1e6},
                          {"pressure_a_gain", 1.02},
                          {"pressure_b_gain", 0.95},
                          {"load_pressure_gain", 0.97},
                          {"pressure_a_lag", 2e-3},
                          {"pressure_b_lag", 5e-3},
                          {"load_pressure_lag", 3e-3},
                          {"air_fraction", 0.01},
                          {"air_exponent", 1.3},
                          {"leakage_coefficient", 0.5},
                          {"leakage_resistance", 2e11},
                          {"laminar_leakage", 3e-12},
                          {"external_leakage_a", 2e-12},
                          {"external_leakage_b", 3e-12},
                          {"transport_delay", 3e-3}};
  const NamedValues valve{{"pilot_exponent", 1.7},       {"pilot_range", 1e6},
                          {"gain_supply_to_a", 1.1},     {"gain_a_to_tank", 0.9},
                          {"gain_supply_to_b", 0.8},     {"gain_b_to_tank", 1.2},
                          {"valve_null_leakage", 2e-12}, {"valve_time_constant", 8e-3},
                          {"supply_resistance", 1e9},    {"supply_capacity", 2e-12},
                          {"pump_flow", 5e-4},           {"pump_second_flow", 9e-4},
                          {"pump_delay", 0.05},          {"pump_first_rate", 3e-3},
                          {"return_dead_band", 1.2e6},   {"return_exponent", 1.4},
                          {"return_line_opening", 2e-4}, {"pump_rise", 0.02},
                          {"make_up_conductance", 1e-9}, {"return_line_resistance", 2e9}};
  const NamedValues centre{{"supply_resistance", 1e9}, {"supply_capacity", 2e-12},
                           {"pump_flow", 5e-4},        {"bypass_opening", 3e-4},
                           {"bypass_range", 1.5e6},    {"return_line_resistance", 4e9}};
  std::set<int> seen;
  const auto check = [&seen](const Scenario& scenario, const Experiment& rig) {
    CAPTURE(scenario.name);
    Experiment e = experiment(scenario, rig);
    check_sensitivities(e, seen,
                        {{Output::load_pressure, 2e7},
                         {Output::force, 8e4},
                         {Output::torque, 2.4e4},
                         {Output::servo_flow, 1e-2},
                         {Output::leakage_flow, 3e-4},
                         {Output::acceleration, 20.0}});
  };
  check({"joint, sensors and leaks", Signal::sine(3e6, 10.0), joint, none, InitialState::given},
        arm_rig());
  check({"pilot valve and pump", Signal::sine(3e6, 8.0), valve, none}, arm_rig());
  check({"cylinder with pre-sliding and seals",
         Signal::sine(3e6, 8.0),
         {{"lever_gradient", 0.3},
          {"coulomb_friction", 4e3},
          {"stribeck_friction", 4e3},
          {"stribeck_velocity", 0.1},
          {"seal_friction", 3e-4},
          {"bristle_stiffness", 4e6},
          {"bristle_damping", 4e4}},
         none},
        arm_rig());
  check({"cylinder on a lubricant film",
         Signal::sine(3e6, 8.0),
         {{"lever_gradient", 0.3},
          {"coulomb_friction", 2e3},
          {"stribeck_friction", 2e4},
          {"stribeck_velocity", 0.3},
          {"friction_smoothing", 0.04},
          {"bristle_stiffness", 1e7},
          {"bristle_damping", 1e4},
          {"film_velocity", 0.1},
          {"film_growth_time", 0.01},
          {"film_decay_time", 0.02},
          {"film_dwell_time", 0.02}},
         none},
        arm_rig());
  check({"open centre", Signal::sine(3e6, 8.0), centre, none}, arm_rig());
  const NamedValues triangle{{"triangle_base", 1.2},
                             {"triangle_arm", 0.35},
                             {"triangle_angle", 1.3},
                             {"reference_angle", -0.1},
                             {"gravity_moment", 3e3}};
  check({"triangle", Signal::sine(3e6, 8.0), triangle, none}, arm_rig().unset("lever"));
  const NamedValues travel{{"travel_table_from", -1.2}, {"travel_table_to", 1.3},
                           {"travel_0", 0.05},          {"travel_20", 0.15},
                           {"travel_40", 0.29},         {"travel_60", 0.45},
                           {"travel_80", 0.57},         {"travel_100", 0.66}};
  check({"travel by a table", Signal::sine(3e6, 8.0), travel, none}, arm_rig().unset("lever"));
  Experiment vane = arm_rig().unset("lever").unset("area_a").unset("area_b");
  vane.set("displacement_per_radian", 1e-3).set("gravity_moment", 3e3);
  check({"rotary actuator", Signal::sine(3e6, 8.0), {{"laminar_leakage", 1e-11}}, none}, vane);
  Experiment pressed = arm_rig();
  pressed.set("lower_stop", -0.01).set("upper_stop", 0.005).set("stop_stiffness", 5e6);
  check({"into both stops", Signal::sine(4e6, 8.0), {{"stop_damping", 2.0}}, none}, pressed);
  Experiment pulled = arm_rig();
  pulled.set("gain_supply_to_a", 0.01).set("gravity_moment", -3e4).set("joint_damping", 4e3);
  check({"pulled empty", Signal::constant(3e6), {{"make_up_conductance", 1e-9}}, none}, pulled);
  Experiment electric = arm_rig();
  electric.rig.pilot = false;
  electric.values.set("valve_gain", 2e-4);
  electric.unset("pilot_gain").unset("pilot_dead_band");
  check({"electric valve of second order",
         Signal::sine(4.0, 10.0),
         {{"valve_dead_band", 0.3},
          {"valve_offset", 0.1},
          {"valve_frequency", 300.0},
          {"valve_damping_ratio", 0.8},
          {"valve_rate_limit", 100.0},
          {"main_spool_gain", 200.0}},
         none},
        electric);
  check({"power of the command, load sensing, accumulator",
         Signal::sine(4.0, 10.0),
         {{"valve_exponent", 1.6},
          {"valve_range", 5.0},
          {"supply_resistance", 2e10},
          {"supply_capacity", 2e-12},
          {"load_sensing_margin", 6e6},
          {"accumulator_volume", 1e-4},
          {"accumulator_precharge", 3e6},
          {"accumulator_exponent", 1.3}},
         none},
        electric);
  Experiment looped = electric;
  looped.rig.controller = ControllerKind::pid;
  looped.rig.feedback = Feedback::angle;
  looped.set("angle_kp", 10.0);
  check({"loop on the angle",
         Signal::sine(0.5, 8.0),
         {{"angle_ki", 80.0},
          {"angle_kd", 0.05},
          {"derivative_filter", 200.0},
          {"pressure_feedback", 5e-8},
          {"initial_integral", 0.4},
          {"initial_angle", 0.1},
          {"valve_time_constant", 8e-3},
          {"transport_delay", 3e-3}},
         ControllerKind::pid,
         InitialState::given,
         false,
         Feedback::angle},
        looped);
  check({"loop on the angle at its limit",
         Signal::sine(0.5, 8.0),
         {{"angle_ki", 40.0}, {"output_limit", 2.0}},
         ControllerKind::pid,
         InitialState::rest,
         false,
         Feedback::angle},
        looped);
  check({"sampled loop on the angle",
         Signal::sine(0.5, 8.0),
         {{"angle_ki", 40.0},
          {"angle_kd", 0.05},
          {"derivative_filter", 200.0},
          {"sample_time", 7e-3}},
         ControllerKind::pid,
         InitialState::rest,
         false,
         Feedback::angle},
        looped);
  check({"loop on the angle with feed-forward",
         Signal::sine(0.5, 8.0),
         {{"angular_velocity_feedforward", 0.1},
          {"angular_acceleration_feedforward", 1e-3},
          {"derivative_filter", 200.0},
          {"valve_time_constant", 8e-3}},
         ControllerKind::pid,
         InitialState::rest,
         false,
         Feedback::angle},
        looped);
  looped.unset("angle_kp").set("gravity_moment_gradient", 1e5);
  check({"loop on the torque",
         Signal::sine(4e3, 8.0),
         {{"torque_kp", 5e-4},
          {"torque_ki", 5e-3},
          {"torque_kd", 2e-6},
          {"derivative_filter", 200.0},
          {"joint_friction", 300.0},
          {"joint_friction_smoothing", 0.2},
          {"valve_time_constant", 8e-3}},
         ControllerKind::pid,
         InitialState::rest,
         false,
         Feedback::torque},
        looped);
  check({"loop on the load pressure",
         Signal::sine(3e6, 8.0),
         {{"load_pressure_kp", 5e-7},
          {"load_pressure_ki", 5e-6},
          {"load_pressure_kd", 2e-9},
          {"derivative_filter", 200.0},
          {"valve_time_constant", 8e-3}},
         ControllerKind::pid,
         InitialState::rest,
         false,
         Feedback::load_pressure},
        looped);
  check({"warm oil",
         Signal::sine(4.0, 10.0),
         {{"reference_temperature", 313.15},
          {"oil_temperature", 338.15},
          {"viscosity_decay", 0.03},
          {"thermal_expansion", 7e-4},
          {"bulk_modulus_decay", 5.5e-3},
          {"laminar_leakage", 1e-11}},
         none},
        electric);
  check({"table of the command, relief valves",
         Signal::sine(4.0, 10.0),
         {{"valve_range", 4.0},
          {"opening_20", 0.1},
          {"opening_40", 0.25},
          {"opening_60", 0.5},
          {"opening_80", 0.75},
          {"compensator_pressure", 8e5},
          {"relief_pressure", 1.1e7},
          {"relief_conductance", 1e-10}},
         none},
        electric);
  check_all_seen(PlantKind::linkage, seen);
}
