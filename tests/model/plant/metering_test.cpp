// Tests valve, pump and check valves of cylinders with two chambers: each term against its closed
// form, and all terms together against an integrator and a right-hand side in this file
// (docs/model.md, section 10).

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "model/plant/layout.hpp"
#include "model/plant/terms.hpp"
#include "tests/model/end_of_run.hpp"
#include "tests/model/runge_kutta.hpp"
#include "tests/model/sensitivity.hpp"
#include "tests/model/two_chamber_rig.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

/// Outputs at the last sample, in the order of e.outputs.
Eigen::RowVectorXd last_of_slide(const Experiment& e) {
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  return run.outputs.row(run.outputs.rows() - 1);
}

/// Supply pressure at the valve at the last sample [Pa].
double valve_supply_pa(const Experiment& e) {
  const Layout layout = layout_of(e.rig, e.values, {}, 4);
  REQUIRE(layout.supply >= 0);
  return end_of_run(e).state[static_cast<std::size_t>(layout.supply)];
}

/// Flow through an open edge of pilot_rig() [m3/s].
double edge_flow_of(double opening_m, double head_pa) {
  return 0.65 * 0.02 * opening_m * std::sqrt(2.0 * head_pa / 870.0);
}

/// pilot_rig() with every term of valve, pump and check valves.
Experiment all_metering_terms() {
  Experiment e = pilot_rig();
  e.set("pilot_gain", 8e-11).set("pilot_exponent", 1.6).set("pilot_range", 1.5e6);
  e.set("gain_a_to_tank", 0.8).set("gain_b_to_tank", 0.7).set("gain_supply_to_b", 1.2);
  e.set("return_dead_band", 0.8e6).set("return_exponent", 1.3).set("return_line_opening", 3e-4);
  e.set("return_line_resistance", 2e9).set("compensator_pressure", 8e5);
  e.set("bypass_opening", 5e-5).set("bypass_range", 1.2e6).set("valve_null_leakage", 1e-12);
  e.set("supply_resistance", 2e9).set("supply_capacity", 5e-12).set("pump_flow", 5e-4);
  e.set("pump_second_flow", 8e-4).set("pump_delay", 0.4).set("pump_rise", 0.1);
  e.set("pump_first_rate", 2e-4).set("load_sensing_margin", 2e6).set("accumulator_volume", 2e-4);
  e.set("accumulator_precharge", 2e6).set("accumulator_exponent", 1.3);
  e.set("make_up_conductance", 2e-9).set("relief_pressure", 9e6).set("relief_conductance", 3e-10);
  e.set("external_force", 8e3).set("load_gradient", 3e4);
  e.inputs.drive = Signal::sine(2.6e6, 0.8);
  return e;
}

/// An independent implementation of the equations in section 10 for all_metering_terms(). The
/// states are position, velocity, both pressures, supply pressure at the valve and demand time.
using SlideState = std::array<double, 6>;
SlideState slide_rates(const SlideState& x, double t) {
  constexpr double kTank_pa = 2e5;
  const double pilot_pa = 2.6e6 * std::sin(2.0 * kPi * 0.8 * t);
  const auto root = [](double head_pa) {
    return head_pa / std::pow(head_pa * head_pa + 1e4, 0.25);  // eps = 100 Pa
  };
  const double per_opening = 0.65 * 0.02 * std::sqrt(2.0 / 870.0);
  const auto travel = [](double beyond_pa, double exponent) {
    return beyond_pa <= 0.0 ? 0.0 : 8e-11 * 1.5e6 * std::pow(beyond_pa / 1.5e6, exponent);
  };
  const auto in = [&](double way_pa, double gain, double p) {
    const double head = x[4] - p;
    const double across = std::min(head, 8e5);
    return gain * per_opening * travel(way_pa - 1e6, 1.6) * root(across) + 1e-12 * head;
  };
  const auto out = [&](double way_pa, double gain, double p) {
    const double y = travel(way_pa - 0.8e6, 1.3);
    const double conductance = gain * per_opening * y / std::sqrt(1.0 + std::pow(y / 3e-4, 2));
    const double head = p - kTank_pa;
    // Edge and line in series, solved by bisection instead of the closed form.
    double low = 0.0;
    double high = conductance * std::sqrt(std::abs(head));
    for (int i = 0; i < 60 && high > 0.0; ++i) {
      const double flow = 0.5 * (low + high);
      const double rest = std::abs(head) - 2e9 * flow;
      (flow * flow > conductance * conductance * rest ? high : low) = flow;
    }
    return std::copysign(0.5 * (low + high), head) + 1e-12 * head;
  };
  const double q_a = in(pilot_pa, 1.0, x[2]) - out(-pilot_pa, 0.8, x[2]);
  const double q_b = in(-pilot_pa, 1.2, x[3]) - out(pilot_pa, 0.7, x[3]);
  const auto ports = [&](double p) {
    return 2e-9 * std::max(kTank_pa - p, 0.0) - 3e-10 * std::max(p - 9e6, 0.0);
  };
  const double force = 4e-3 * x[2] - 2.4e-3 * x[3] - 4e4 * x[1] - 8e3 - 3e4 * x[0];
  const double volume_a = 1e-3 + 4e-3 * (x[0] + 0.5);
  const double volume_b = 1e-3 + 2.4e-3 * (0.5 - x[0]);
  const double asked = std::tanh(std::max(std::abs(pilot_pa) - 1e6, 0.0) / 1e5);
  const double driven = pilot_pa < 0.0 ? x[3] : x[2];
  const double kept = std::min(2e7, kTank_pa + 2e6 + asked * std::max(driven - kTank_pa, 0.0));
  const double first = 5e-4 + 2e-4 * x[5];
  const double largest = first + 0.5 * (8e-4 - first) * (1.0 + std::tanh((x[5] - 0.4) / 0.1));
  const double pump = std::min((kept - x[4]) / 2e9, largest);
  const double closed = std::max(std::abs(pilot_pa) - 1e6, 0.0) / 1.2e6;
  const double bypass = per_opening * 5e-5 * std::max(1.0 - closed, 0.0) * root(x[4] - kTank_pa);
  const double taken = in(pilot_pa, 1.0, x[2]) + in(-pilot_pa, 1.2, x[3]) + bypass;
  const double p = x[4] + 101325.0;
  const double p_0 = 2e6 + 101325.0;
  const double gas = 0.5 * (1.0 + std::tanh((p / p_0 - 1.0) / 0.02)) * 2e-4 / (1.3 * p) *
                     std::pow(p_0 / p, 1.0 / 1.3);
  return {x[1],
          force / 2000.0,
          8e8 / volume_a * (q_a + ports(x[2]) - 4e-3 * x[1]),
          8e8 / volume_b * (q_b + ports(x[3]) + 2.4e-3 * x[1]),
          (pump - taken) / (5e-12 + gas),
          asked - (1.0 - asked) * x[5] / 0.4};
}

}  // namespace

TEST_CASE("metering: all terms together follow an integrator of another kind", "[model]") {
  Experiment e = all_metering_terms();
  e.times_s = grid(0.0, 1.4, 15);
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  const SlideState start{0.0, 0.0, run.outputs(0, 2), run.outputs(0, 3), 2e7, 0.0};
  const Eigen::MatrixXd other = runge_kutta(start, e.times_s, 16000, slide_rates).leftCols(4);
  REQUIRE(peak(other.col(0)) > 5e-3);
  CHECK(difference(run.outputs, other) < 2e-5);
  e.options.method = Method::dopri5;
  const Simulation explicit_run = e();
  REQUIRE(explicit_run.ok());
  CHECK(difference(run.outputs, explicit_run.outputs) < 2e-5);
}

TEST_CASE("metering: on a constant lever the terms are those of the cylinder that slides",
          "[model]") {
  constexpr double kLever = 0.25;
  Experiment sliding = all_metering_terms();
  sliding.set("external_force", 0.0).set("load_gradient", 0.0);
  sliding.times_s = grid(0.0, 1.4, 141);
  Experiment turning = sliding;
  turning.rig.plant = PlantKind::linkage;
  turning.values = ParameterValues::defaults(PlantKind::linkage);
  const auto table = parameter_table(PlantKind::two_chamber);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const int index = parameter_index(PlantKind::linkage, table[i].key);
    if (sliding.values.given[i] && index >= 0) turning.values.set(index, sliding.values.value[i]);
  }
  turning.set("lever", kLever).set("inertia", 2000.0 * kLever * kLever);
  turning.set("joint_damping", 4e4 * kLever * kLever);
  turning.set("lower_stop", -0.5 / kLever).set("upper_stop", 0.5 / kLever);
  const Simulation slid = sliding();
  const Simulation turned = turning();
  REQUIRE(slid.ok());
  REQUIRE(turned.ok());
  REQUIRE(peak(slid.outputs.col(0)) > 5e-3);
  CHECK(difference(slid.outputs, turned.outputs) < 1e-6);
}

TEST_CASE("metering: in steady motion the flows are those of the edges", "[model]") {
  for (const double sign : {1.0, -1.0}) {
    Experiment e = pilot_rig();
    e.inputs.drive = Signal::constant(sign * 2e6);
    e.set("gain_b_to_tank", 0.7).set("gain_a_to_tank", 0.6).set("return_dead_band", 1.5e6);
    e.set("return_exponent", 2.0).set("pilot_range", 1e6).set("return_line_resistance", 2e11);
    e.set("pilot_exponent", 1.0).set("stroke", 2.0).set("bulk_modulus", 8e10);
    e.times_s = {0.0, 20.0};
    const auto end = last_of_slide(e);
    const bool out = sign > 0.0;
    const double driven_m2 = out ? 4e-3 : 2.4e-3;
    const double other_m2 = out ? 2.4e-3 : 4e-3;
    const double speed = std::abs(end(1));
    REQUIRE(speed > 3e-4);
    CHECK_THAT(edge_flow_of(1e-5, 2e7 - end(out ? 2 : 3)), WithinRel(driven_m2 * speed, 1e-4));
    const double port_pa = 2e5 + 2e11 * other_m2 * speed;
    CHECK_THAT((out ? 0.7 : 0.6) * edge_flow_of(1e-5 * 0.25, end(out ? 3 : 2) - port_pa),
               WithinRel(other_m2 * speed, 1e-4));
  }
}

TEST_CASE("metering: behind a compensator the speed does not depend on the load", "[model]") {
  for (const double load_n : {0.0, 2e4, 4e4}) {
    Experiment e = pilot_rig();
    e.set("compensator_pressure", 6e5).set("external_force", load_n).set("stroke", 2.0);
    e.set("bulk_modulus", 8e10).times_s = {0.0, 20.0};
    const auto end = last_of_slide(e);
    CHECK_THAT(end(1), WithinRel(edge_flow_of(1e-5, 6e5) / 4e-3, 1e-6));
  }
  // Below the spring pressure, the edge acts as if it had no compensator.
  CHECK(compensated_head(3e5, 6e5) == 3e5);
  CHECK(compensated_head(-3e5, 6e5) == -3e5);
  CHECK(compensated_head(7e5, 6e5) == 6e5);
}

TEST_CASE("metering: the spool opens by a power or a table of the command, both ways alike",
          "[model]") {
  Experiment by_power = proportional_rig();
  by_power.set("valve_exponent", 2.5).set("valve_range", 8.0);
  Experiment by_table = proportional_rig();
  by_table.set("valve_range", 10.0).set("opening_20", 0.05).set("opening_40", 0.2);
  by_table.set("opening_80", 0.7);  // 0.6 at 60 % by default
  by_power.outputs = by_table.outputs = {Output::spool};
  for (const double sign : {1.0, -1.0}) {
    for (const double beyond_v : {1.0, 4.0, 8.0, 9.0}) {
      by_power.inputs.drive = Signal::constant(sign * (0.5 + beyond_v));
      CHECK_THAT(last_of_slide(by_power)(0),
                 WithinRel(sign * 2e-6 * 8.0 * std::pow(beyond_v / 8.0, 2.5), 1e-12));
    }
    const std::array<std::array<double, 2>, 6> points{
        {{1.0, 0.25}, {2.0, 0.5}, {5.0, 4.0}, {8.0, 7.0}, {10.0, 10.0}, {11.0, 11.5}}};
    for (const auto& [beyond_v, opening_v] : points) {
      by_table.inputs.drive = Signal::constant(sign * (0.5 + beyond_v));
      CHECK_THAT(last_of_slide(by_table)(0), WithinRel(sign * 2e-6 * opening_v, 1e-12));
    }
  }
  by_table.inputs.drive = Signal::constant(0.4);
  CHECK(last_of_slide(by_table)(0) == 0.0);
}

TEST_CASE("metering: a pump of limited flow decides the speed, then its second flow does",
          "[model]") {
  Experiment e = proportional_rig();
  e.set("stroke", 4.0).set("supply_resistance", 1e9).set("supply_capacity", 1e-12);
  e.set("valve_gain", 2e-4).set("pump_flow", 4e-4);
  e.times_s = {0.0, 1.5};
  CHECK_THAT(last_of_slide(e)(1), WithinRel(4e-4 / 4e-3, 1e-5));
  e.set("pump_second_flow", 6e-4).set("pump_delay", 4.0).set("pump_rise", 0.1);
  e.times_s = {0.0, 3.0, 8.0};
  const Simulation run = e();
  REQUIRE(run.ok());
  CHECK_THAT(run.outputs(1, 1), WithinRel(4e-4 / 4e-3, 1e-3));
  CHECK_THAT(run.outputs(2, 1), WithinRel(6e-4 / 4e-3, 1e-3));
}

TEST_CASE("metering: through an open centre the pump's pressure follows the spool", "[model]") {
  Experiment e = proportional_rig();
  e.set("supply_resistance", 1e9).set("supply_capacity", 1e-12).set("pump_flow", 5e-4);
  e.set("bypass_opening", 4e-4).set("valve_bypass_range", 8.0).set("stroke", 0.2);
  e.set("valve_gain", 2e-5);
  e.times_s = {0.0, 20.0};
  for (const double beyond_v : {2.0, 4.0}) {  // the piston is at its stop
    e.inputs.drive = Signal::constant(0.5 + beyond_v);
    const double a_pa = last_of_slide(e)(2);
    CHECK_THAT(edge_flow_of(4e-4 * (1.0 - beyond_v / 8.0), a_pa - 2e5), WithinRel(5e-4, 1e-4));
  }
}

TEST_CASE("metering: a load-sensing pump keeps its margin above the driven chamber", "[model]") {
  Experiment e = proportional_rig();
  e.set("supply_resistance", 1e8).set("supply_capacity", 1e-11).set("load_sensing_margin", 1.5e6);
  e.set("external_force", 1.2e4).set("stroke", 2.0).set("valve_gain", 1e-5);
  e.times_s = {0.0, 20.0};
  const auto moving = last_of_slide(e);
  const double asked = std::tanh(5.0 / 0.1);
  CHECK_THAT(valve_supply_pa(e),
             WithinRel(2e5 + asked * (moving(2) - 2e5) + 1.5e6 - 1e8 * 4e-3 * moving(1), 1e-6));
  e.inputs.drive = Signal::constant(-5.5);
  const auto back = last_of_slide(e);
  CHECK_THAT(valve_supply_pa(e), WithinRel(back(3) + 1.5e6 + 1e8 * 2.4e-3 * back(1), 1e-6));
  e.inputs.drive = Signal::constant(0.0);  // valve closed: standby pressure
  CHECK_THAT(valve_supply_pa(e), WithinRel(2e5 + 1.5e6, 1e-6));
  e.set("stroke", 0.1).inputs.drive = Signal::constant(5.5);  // piston at its stop: pressure limit
  CHECK_THAT(valve_supply_pa(e), WithinRel(2e7, 1e-4));
}

TEST_CASE("metering: an accumulator gives oil by the gas law", "[model]") {
  Experiment e = proportional_rig();
  e.set("supply_resistance", 1e15)
      .set("supply_capacity", 1e-18)
      .set("stroke", 2.0);  // no flow from the pump
  e.set("accumulator_volume", 4e-3).set("accumulator_precharge", 8e6);
  e.set("accumulator_exponent", 1.25).set("valve_gain", 1e-5).set("bulk_modulus", 8e10);
  const auto end = last_of_slide(e);
  const auto gas_m3 = [](double p_pa) {
    return 4e-3 * std::pow((8e6 + 101325.0) / (p_pa + 101325.0), 1.0 / 1.25);
  };
  const double supply_pa = valve_supply_pa(e);
  REQUIRE(supply_pa > 1e7);
  REQUIRE(supply_pa < 1.9e7);
  // The oil that left the accumulator went into chamber A. In this test, oil is almost rigid.
  CHECK_THAT(gas_m3(supply_pa) - gas_m3(2e7), WithinRel(4e-3 * end(0), 2e-3));
  // Below the precharge, the accumulator contains no oil.
  CHECK(accumulator_capacity(6e6, 4e-3, 8e6, 1.25) <
        1e-9 * accumulator_capacity(9e6, 4e-3, 8e6, 1.25));
}

TEST_CASE("metering: a relief valve opens where a load pushes the piston in", "[model]") {
  Experiment e = proportional_rig();
  e.inputs.drive = Signal::constant(0.0);
  e.set("external_force", 6e4).set("relief_pressure", 1.1e7).set("relief_conductance", 1e-10);
  e.set("make_up_conductance", 1e-8).set("stroke", 2.0);
  const auto end = last_of_slide(e);
  REQUIRE(end(1) < -1e-3);
  CHECK_THAT(1e-10 * (end(2) - 1.1e7), WithinRel(-4e-3 * end(1), 1e-4));
  // The tank fills the other chamber.
  CHECK_THAT(1e-8 * (2e5 - end(3)), WithinRel(-2.4e-3 * end(1), 1e-3));
  CHECK_THAT(4e-3 * end(2) - 2.4e-3 * end(3) - 4e4 * end(1), WithinRel(6e4, 1e-4));
}
