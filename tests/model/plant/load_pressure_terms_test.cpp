// Tests sign and size of every optional term of the load-pressure plant against steady states and
// exact solutions that were derived by hand (docs/model.md). Agreement between two methods, or
// between derivatives and differences, would prove neither.

#include <catch2/catch.hpp>
#include <cmath>

#include "model/plant/load_pressure.hpp"
#include "tests/model/rig.hpp"
#include "tests/model/runge_kutta.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

constexpr double kArea_m2 = 1.62e-3;

double pressure_root(double pressure_pa) {
  return std::copysign(std::sqrt(std::abs(pressure_pa)), pressure_pa);
}

/// The paper's rig with a constant command, without optional terms and without its leak.
Experiment driven_by(double command_v) {
  Experiment e;
  e.rig.controller = ControllerKind::none;
  e.inputs.drive = Signal::constant(command_v);
  e.set("leakage_coefficient", 0.0).set("damping", 4000.0);
  e.times_s = {0.0, 5.0};  // the ringing has decayed to exp(-b / 2m * 5 s) = 1e-51
  e.outputs = {Output::velocity,   Output::load_pressure, Output::spool,
               Output::servo_flow, Output::leakage_flow,  Output::work_flow,
               Output::force,      Output::pressure_a,    Output::pressure_b};
  e.options.tolerance = 1e-9;
  return e;
}

struct SteadyLoad {
  double v, P_L, spool_m, servo_flow, leakage_flow, work_flow, force_n, p_A, p_B;
};

SteadyLoad steady_load(const Experiment& e) {
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  const auto last = run.outputs.row(run.outputs.rows() - 1);
  return {last(0), last(1), last(2), last(3), last(4), last(5), last(6), last(7), last(8)};
}

/// Flow of the valve for a spool travel, eq. 4.
double valve_flow(double spool_m, double P_L) {
  const double direction = spool_m < 0.0 ? -1.0 : 1.0;
  return 0.6 * 0.02075 * spool_m * pressure_root((6.2e6 - direction * P_L) / 847.0);
}

/// Spool travel of the paper's valve, eq. 6.
double travel(double command_v) { return 0.0406e-3 * command_v; }

}  // namespace

TEST_CASE("load_pressure: the valve's null leak takes flow from the load", "[model]") {
  for (const double command_v : {1.0, -2.0}) {
    Experiment e = driven_by(command_v);
    e.set("valve_null_leakage", 5e-11).set("external_force", 3000.0);
    const SteadyLoad s = steady_load(e);
    CAPTURE(command_v, s.P_L);
    CHECK(std::abs(s.P_L) > 1e6);
    CHECK_THAT(kArea_m2 * s.v,
               WithinRel(valve_flow(travel(command_v), s.P_L) - 5e-11 * s.P_L, 1e-6));
    CHECK_THAT(s.servo_flow, WithinRel(kArea_m2 * s.v, 1e-6));  // the flow that reaches the load
    CHECK(s.leakage_flow == 0.0);                               // none of it crosses the piston
  }
}

TEST_CASE("load_pressure: orifice and laminar leak take flow from the load", "[model]") {
  struct Row {
    double coefficient, laminar;
  };
  for (const Row& row : {Row{0.35, 0.0}, Row{0.0, 2e-11}, Row{0.35, 2e-11}}) {
    for (const double force_n : {3000.0, -3000.0}) {
      Experiment e = driven_by(1.0);
      e.set("leakage_coefficient", row.coefficient).set("laminar_leakage", row.laminar);
      e.set("external_force", force_n);
      const SteadyLoad s = steady_load(e);
      const double leak =
          row.coefficient * 4.456e-6 * pressure_root(2.0 * s.P_L / 847.0) + row.laminar * s.P_L;
      CAPTURE(row.coefficient, row.laminar, s.P_L);
      CHECK_THAT(s.leakage_flow, WithinRel(leak, 1e-6));
      CHECK_THAT(s.servo_flow, WithinRel(valve_flow(travel(1.0), s.P_L), 1e-6));
      CHECK_THAT(kArea_m2 * s.v, WithinRel(s.servo_flow - leak, 1e-6));
      CHECK_THAT(s.work_flow, WithinRel(kArea_m2 * s.v, 1e-9));
    }
  }
}

TEST_CASE("load_pressure: a constant force is held by the load pressure", "[model]") {
  for (const double force_n : {800.0, -800.0}) {
    Experiment e = driven_by(1.0);
    e.set("external_force", force_n);
    const SteadyLoad s = steady_load(e);
    CHECK_THAT(kArea_m2 * s.P_L, WithinRel(4000.0 * s.v + force_n, 1e-6));
    CHECK_THAT(s.force_n, WithinRel(kArea_m2 * s.P_L, 1e-9));
    CHECK_THAT(s.p_A, WithinRel(3.1e6 + 0.5 * s.P_L, 1e-9));
    CHECK_THAT(s.p_B, WithinRel(3.1e6 - 0.5 * s.P_L, 1e-9));
  }
}

TEST_CASE("load_pressure: a recorded force adds to the constant one", "[model]") {
  Experiment e = driven_by(1.0);
  e.set("external_force", 500.0);
  e.inputs.external_load = Signal::constant(300.0);
  const SteadyLoad both = steady_load(e);
  CHECK_THAT(kArea_m2 * both.P_L, WithinRel(4000.0 * both.v + 800.0, 1e-6));
  e.set("external_force", 0.0);
  const SteadyLoad recorded = steady_load(e);
  CHECK_THAT(kArea_m2 * recorded.P_L, WithinRel(4000.0 * recorded.v + 300.0, 1e-6));
}

TEST_CASE("load_pressure: dry friction opposes the motion and stays within the cylinder",
          "[model]") {
  for (const double direction : {1.0, -1.0}) {
    Experiment e = driven_by(direction);
    e.set("coulomb_friction", 300.0);
    const SteadyLoad coulomb = steady_load(e);
    CHECK(direction * coulomb.v > 0.02);  // tanh(20) is 1 to the last digit
    CHECK_THAT(kArea_m2 * coulomb.P_L, WithinRel(4000.0 * coulomb.v + direction * 300.0, 1e-6));
    // The rod transmits only the force of the damper.
    CHECK_THAT(coulomb.force_n, WithinRel(4000.0 * coulomb.v, 1e-6));

    e.set("stribeck_friction", 200.0).set("stribeck_velocity", 0.05);
    const SteadyLoad both = steady_load(e);
    const double breakaway = 200.0 * std::exp(-std::pow(both.v / 0.05, 2));
    CHECK(breakaway > 50.0);
    CHECK_THAT(kArea_m2 * both.P_L,
               WithinRel(4000.0 * both.v + direction * (300.0 + breakaway), 1e-6));
    CHECK_THAT(both.force_n, WithinRel(4000.0 * both.v, 1e-6));
  }
}

TEST_CASE("load_pressure: friction is straightened within its smoothing velocity", "[model]") {
  Experiment e = driven_by(1.0);
  e.set("coulomb_friction", 300.0).set("friction_smoothing", 0.05);
  const SteadyLoad s = steady_load(e);
  CHECK_THAT(kArea_m2 * s.P_L, WithinRel(4000.0 * s.v + 300.0 * std::tanh(s.v / 0.05), 1e-6));
}

TEST_CASE("load_pressure: null shift adds to the command, overlap takes from its size", "[model]") {
  struct Row {
    double command_v, offset_v, dead_band_v, opening_v;
  };
  for (const Row& row :
       {Row{1.0, 0.2, 0.0, 1.2}, Row{-1.0, 0.2, 0.0, -0.8}, Row{1.0, 0.0, 0.3, 0.7},
        Row{-1.0, 0.0, 0.3, -0.7}, Row{1.0, -0.2, 0.3, 0.5}, Row{-1.0, -0.2, 0.3, -0.9}}) {
    Experiment e = driven_by(row.command_v);
    e.set("valve_offset", row.offset_v).set("valve_dead_band", row.dead_band_v);
    const SteadyLoad s = steady_load(e);
    CHECK_THAT(s.spool_m, WithinRel(travel(row.opening_v), 1e-12));
    CHECK_THAT(kArea_m2 * s.v, WithinRel(valve_flow(travel(row.opening_v), s.P_L), 1e-6));
  }
}

TEST_CASE("load_pressure: a spring ends where it holds what the valve can press", "[model]") {
  Experiment e = driven_by(1.0);
  e.set("stiffness", 2e5).set("laminar_leakage", 1e-10).set("external_force", 700.0);
  e.outputs = {Output::position, Output::velocity, Output::load_pressure};
  e.times_s = {0.0, 20.0};
  const Simulation run = e();
  REQUIRE(run.ok());
  const double P_L = run.outputs(1, 2);
  CHECK_THAT(run.outputs(1, 1), WithinAbs(0.0, 1e-8));
  CHECK_THAT(2e5 * run.outputs(1, 0), WithinRel(kArea_m2 * P_L - 700.0, 1e-6));
  CHECK_THAT(1e-10 * P_L, WithinRel(valve_flow(travel(1.0), P_L), 1e-6));
}

TEST_CASE("load_pressure: the hydraulic mode turns at sqrt(4 beta A^2 / V_t m)", "[model]") {
  Experiment e = driven_by(0.0);
  e.rig.initial = InitialState::given;
  e.set("damping", 0.0).set("initial_velocity", 0.01);
  e.times_s = grid(0.0, 0.1, 101);
  e.outputs = {Output::velocity, Output::load_pressure};
  const Simulation run = e();
  REQUIRE(run.ok());
  const double capacity = 2.46888e-4 / (4.0 * 689e6);
  const double omega = kArea_m2 / std::sqrt(capacity * 85.0);
  for (int i = 0; i < 101; ++i) {
    const double t = 1e-3 * i;
    CHECK_THAT(run.outputs(i, 0), WithinAbs(0.01 * std::cos(omega * t), 1e-6));
    // m v' = A P_L
    CHECK_THAT(run.outputs(i, 1),
               WithinAbs(-85.0 * 0.01 * omega / kArea_m2 * std::sin(omega * t), 50.0));
  }
}

TEST_CASE("load_pressure: at the start the load pressure holds force and spring", "[model]") {
  Experiment e = driven_by(0.0);
  e.rig.initial = InitialState::given;
  e.set("initial_position", 0.03).set("position_offset", 0.01).set("position_gain", 2.0);
  e.set("stiffness", 5e4).set("external_force", 300.0);
  e.times_s = {0.0};
  e.outputs = {Output::position, Output::load_pressure};
  SECTION("where it was not read") {
    const Simulation run = e();
    REQUIRE(run.ok());
    CHECK_THAT(run.outputs(0, 0), WithinRel(0.03, 1e-12));
    // x = (0.03 - 0.01) / 2
    CHECK_THAT(run.outputs(0, 1), WithinRel((300.0 + 5e4 * 0.01) / kArea_m2, 1e-12));
  }
  SECTION("where it was read, by a sensor with gain and offset") {
    e.set("initial_load_pressure", 2e6).set("load_pressure_offset", 1e5);
    e.set("load_pressure_gain", 1.9);
    e.outputs = {Output::load_pressure, Output::pressure_a};
    const Simulation run = e();
    REQUIRE(run.ok());
    CHECK_THAT(run.outputs(0, 0), WithinRel(2e6, 1e-12));
    CHECK_THAT(run.outputs(0, 1), WithinRel(0.5 * (6.2e6 + 1e6), 1e-12));
  }
}

TEST_CASE("load_pressure: what acts in one direction cannot be reversed", "[model]") {
  PresentTerms terms;
  CHECK(LoadPressurePlant::reversible(Output::position, terms));
  CHECK_FALSE(LoadPressurePlant::reversible(Output::pressure_a, terms));
  CHECK_FALSE(LoadPressurePlant::reversible(Output::pressure_b, terms));
  terms.external_load = true;
  CHECK_FALSE(LoadPressurePlant::reversible(Output::position, terms));
  terms.external_load = false;
  terms.valve_offset = true;
  CHECK_FALSE(LoadPressurePlant::reversible(Output::position, terms));
  terms.valve_offset = false;
  terms.relief = true;
  CHECK(LoadPressurePlant::reversible(Output::position, terms));
  terms.supply = 3;
  CHECK_FALSE(LoadPressurePlant::reversible(Output::position, terms));
}

TEST_CASE("load_pressure: the supply gives way by its flow, up to what the pump can give",
          "[model]") {
  for (const double command_v : {2.0, -2.0}) {
    CAPTURE(command_v);
    Experiment e = driven_by(command_v);
    e.set("valve_null_leakage", 1e-12);
    e.set("supply_resistance", 2e10).set("supply_capacity", 1e-13);
    const SteadyLoad s = steady_load(e);
    const double supply_pa = s.p_A + s.p_B;
    const double to_load = s.servo_flow + 1e-12 * s.P_L;
    CHECK_THAT(6.2e6 - supply_pa, WithinRel(2e10 * (std::abs(to_load) + 1e-12 * supply_pa), 1e-6));
    REQUIRE(supply_pa < 5e6);
    const double direction = command_v < 0.0 ? -1.0 : 1.0;
    CHECK_THAT(to_load, WithinRel(0.6 * 0.02075 * travel(command_v) *
                                      pressure_root((supply_pa - direction * s.P_L) / 847.0),
                                  1e-6));
    e.set("valve_null_leakage", 0.0).set("pump_flow", 5e-5);
    const SteadyLoad limited = steady_load(e);
    CHECK_THAT(kArea_m2 * limited.v, WithinRel(direction * 5e-5, 1e-6));
    CHECK(limited.p_A + limited.p_B < 6.2e6 - 2e10 * 5e-5);
  }
}

TEST_CASE("load_pressure: an accumulator gives oil by the gas law", "[model]") {
  Experiment e = driven_by(1.0);
  e.set("supply_resistance", 1e15).set("supply_capacity", 1e-18);  // no flow from the pump
  e.set("accumulator_volume", 1e-3).set("accumulator_precharge", 2.5e6);
  e.set("accumulator_exponent", 1.25);
  e.outputs = {Output::position, Output::load_pressure, Output::pressure_a, Output::pressure_b};
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  const auto gas_m3 = [](double p_pa) {
    return 1e-3 * std::pow((2.5e6 + 101325.0) / (p_pa + 101325.0), 1.0 / 1.25);
  };
  const double supply_pa = run.outputs(1, 2) + run.outputs(1, 3);
  REQUIRE(supply_pa > 3e6);
  REQUIRE(supply_pa < 5.5e6);
  const double compressed_m3 = 2.46888e-4 / (4.0 * 689e6) * run.outputs(1, 1);
  CHECK_THAT(gas_m3(supply_pa) - gas_m3(6.2e6),
             WithinRel(kArea_m2 * run.outputs(1, 0) + compressed_m3, 1e-4));
}

TEST_CASE("load_pressure: a relief valve opens where a load pushes the piston", "[model]") {
  for (const double direction : {1.0, -1.0}) {
    CAPTURE(direction);
    Experiment e = driven_by(0.0);
    e.set("external_force", 1.2e4 * direction);
    e.set("relief_pressure", 6.5e6).set("relief_conductance", 1e-10);
    const SteadyLoad s = steady_load(e);
    const double pressed_pa = direction > 0.0 ? s.p_A : s.p_B;
    REQUIRE(direction * s.v < -1e-3);
    // Half of the flow, since the other chamber takes in as little as it likes.
    CHECK_THAT(0.5 * 1e-10 * (pressed_pa - 6.5e6), WithinRel(-direction * kArea_m2 * s.v, 1e-6));
    CHECK_THAT(kArea_m2 * s.P_L, WithinRel(1.2e4 * direction + 4000.0 * s.v, 1e-6));
  }
}

TEST_CASE("load_pressure: a supply that gives way follows an integrator of another kind",
          "[model]") {
  Experiment e = driven_by(0.0);
  e.inputs.drive = Signal::sine(3.0, 5.0);
  e.set("valve_null_leakage", 2e-12).set("external_force", 4000.0);
  e.set("supply_resistance", 1e10).set("supply_capacity", 1e-13).set("pump_flow", 7e-5);
  e.set("accumulator_volume", 2e-6).set("accumulator_precharge", 3e6);
  e.set("accumulator_exponent", 1.3).set("relief_pressure", 3.7e6).set("relief_conductance", 2e-11);
  e.times_s = grid(0.0, 0.4, 41);
  e.outputs = {Output::position, Output::velocity, Output::load_pressure, Output::pressure_a};
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  using RigState = std::array<double, 4>;  // position, velocity, load pressure, supply pressure
  const auto gas = [](double supply_pa) {
    const double p = supply_pa + 101325.0;
    const double first = 3e6 + 101325.0;
    const double above = 0.5 * (std::tanh((p - first) / (0.02 * first)) + 1.0);
    return above * 2e-6 / (1.3 * p) * std::pow(first / p, 1.0 / 1.3);
  };
  const auto relieved = [](double chamber_pa) { return 2e-11 * std::max(chamber_pa - 3.7e6, 0.0); };
  bool limited = false;
  bool opened = false;
  const auto rates = [&](const RigState& x, double t) -> RigState {
    const double spool_m = travel(3.0 * std::sin(10.0 * kPi * t));
    const double open = 0.6 * 0.02075 * std::abs(spool_m) / std::sqrt(847.0);
    const double side = spool_m < 0.0 ? -1.0 : 1.0;
    const double through = open * rounded_root(x[3] - side * x[2]);
    const double lost = 0.5 * (relieved(0.5 * (x[3] + x[2])) - relieved(0.5 * (x[3] - x[2])));
    const double pumped = std::min((6.2e6 - x[3]) / 1e10, 7e-5);
    limited = limited || pumped == 7e-5;
    opened = opened || lost > 1e-6;
    return {x[1], (kArea_m2 * x[2] - 4000.0 * x[1] - 4000.0) / 85.0,
            4.0 * 689e6 / 2.46888e-4 * (side * through - 2e-12 * x[2] - lost - kArea_m2 * x[1]),
            (pumped - through - 2e-12 * x[3]) / (1e-13 + gas(x[3]))};
  };
  const Eigen::MatrixXd states =
      runge_kutta(RigState{0.0, 0.0, 0.0, 6.2e6}, e.times_s, 4000, rates);
  Eigen::MatrixXd other = states;
  other.col(3) = 0.5 * (states.col(3) + states.col(2));
  REQUIRE(peak(other.col(0)) > 1e-3);
  CHECK((limited && opened));
  CHECK(difference(run.outputs, other) < 3e-5);
  e.options.method = Method::dopri5;
  const Simulation explicit_run = e();
  REQUIRE(explicit_run.ok());
  CHECK(difference(run.outputs, explicit_run.outputs) < 3e-5);
}
