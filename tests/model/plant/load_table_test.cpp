// Tests the load from a table over the travel: values, corners, closed forms of the motion on one
// piece, and an integrator of another kind (docs/model.md).

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "model/plant/terms.hpp"
#include "tests/model/runge_kutta.hpp"
#include "tests/model/two_chamber_rig.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

constexpr std::array<double, 6> kLoads_n{900.0, 500.0, 700.0, -300.0, -100.0, 400.0};

double tabled(double place) { return table_load(place, 0.0, 5.0, kLoads_n); }

Experiment with_table(Experiment e, double from_m, double to_m,
                      const std::array<double, 6>& loads_n = kLoads_n) {
  e.set("load_table_from", from_m).set("load_table_to", to_m);
  constexpr std::array kKeys{"load_0", "load_20", "load_40", "load_60", "load_80", "load_100"};
  for (std::size_t i = 0; i < kKeys.size(); ++i) e.set(kKeys[i], loads_n[i]);
  return e;
}

/// The same table as a sum of ramps with rounded starts, one per corner.
double load_of_ramps(double x, double from_m, double to_m) {
  const double place = 5.0 * (x - from_m) / (to_m - from_m);
  double load = kLoads_n[0] + (kLoads_n[1] - kLoads_n[0]) * place;
  for (std::size_t i = 1; i < 5; ++i) {
    const double bend = kLoads_n[i + 1] - 2.0 * kLoads_n[i] + kLoads_n[i - 1];
    const double past = place - static_cast<double>(i);
    double ramp = std::max(past, 0.0);
    if (std::abs(past) < 0.25) ramp = (past + 0.25) * (past + 0.25);
    load += bend * ramp;
  }
  return load;
}

}  // namespace

TEST_CASE("terms: a table of the load is a line between its values, with rounded corners",
          "[model]") {
  CHECK_THAT(tabled(0.0), WithinRel(900.0, 1e-15));
  CHECK_THAT(tabled(5.0), WithinRel(400.0, 1e-15));
  CHECK_THAT(tabled(0.5), WithinRel(700.0, 1e-15));
  CHECK_THAT(tabled(2.5), WithinRel(200.0, 1e-15));
  CHECK_THAT(tabled(4.5), WithinRel(150.0, 1e-15));
  // Beyond its ends, the first and the last piece continue.
  CHECK_THAT(tabled(-3.0), WithinRel(900.0 + 3.0 * 400.0, 1e-15));
  CHECK_THAT(tabled(7.0), WithinRel(400.0 + 2.0 * 500.0, 1e-15));
  // A parabola over half a piece leaves a corner to one side by 1/16 of the change in slope.
  CHECK_THAT(tabled(1.0), WithinRel(500.0 + (200.0 + 400.0) / 16.0, 1e-14));
  CHECK_THAT(tabled(2.0), WithinRel(700.0 + (-1000.0 - 200.0) / 16.0, 1e-14));
  for (const double place : {-1.3, 0.2, 0.76, 0.9, 1.1, 1.24, 2.1, 2.9, 3.1, 3.9, 4.2, 6.0})
    CHECK_THAT(tabled(place), WithinAbs(load_of_ramps(place, 0.0, 5.0), 1e-10));
  // Value and slope are continuous where a parabola begins and ends, and between two corners.
  for (const double place : {0.75, 1.25, 1.5, 1.75, 2.25, 3.5, 3.75, 4.25}) {
    const double before = tabled(place - 1e-6);
    const double after = tabled(place + 1e-6);
    CHECK_THAT(after, WithinAbs(before, 5e-3));
    const double left = (tabled(place) - before) / 1e-6;
    const double right = (after - tabled(place)) / 1e-6;
    CHECK_THAT(right, WithinAbs(left, 0.02));
  }
}

TEST_CASE("terms: a table that falls everywhere never rises", "[model]") {
  constexpr std::array<double, 6> kFalling{100.0, 90.0, 10.0, 9.0, -50.0, -51.0};
  double last = 1e9;
  for (int i = 0; i <= 700; ++i) {
    const double load = table_load(-0.1 + 0.001 * i, 0.0, 0.5, kFalling);
    CHECK(load < last);
    last = load;
  }
}

TEST_CASE("simulate: a load from a table is held where the record starts", "[model]") {
  for (Experiment e : {Experiment{}, two_chamber_rig()}) {
    for (const double x : {0.02, 0.0, -0.03}) {
      e.rig.controller = ControllerKind::none;
      e.rig.initial = InitialState::given;
      e.inputs.drive = Signal::constant(0.0);
      e.set("leakage_coefficient", 0.0).set("initial_position", x).set("external_force", 250.0);
      e.times_s = {0.0, 2.0};
      e.outputs = {Output::position, Output::load_pressure};
      e.options.tolerance = 1e-9;
      const Simulation run = with_table(e, -0.04, 0.05)();
      REQUIRE(run.ok());
      const double load = 250.0 + load_of_ramps(x, -0.04, 0.05);
      CAPTURE(x);
      for (Eigen::Index i = 0; i < 2; ++i) {
        CHECK_THAT(run.outputs(i, 0), WithinAbs(x, 1e-9));
        CHECK_THAT(1.62e-3 * run.outputs(i, 1), WithinRel(load, 1e-7));
      }
    }
  }
}

TEST_CASE("load_pressure: on a piece that falls a mass runs away, on one that rises it swings",
          "[model]") {
  // The piston is so small that its oil has no effect: m x'' = -(F_c + k (x - x_c)).
  const std::array<double, 6> loads_n{0.0, -200.0, -400.0, -600.0, 200.0, 1000.0};
  const auto moving_from = [&](double x0) {
    Experiment e;
    e.rig.controller = ControllerKind::none;
    e.rig.initial = InitialState::given;
    e.inputs.drive = Signal::constant(0.0);
    e.set("piston_area", 1e-8).set("mass", 50.0).set("damping", 0.0);
    e.set("leakage_coefficient", 0.0).set("initial_load_pressure", 0.0).set("initial_position", x0);
    e.times_s = grid(0.0, 0.3, 31);
    e.outputs = {Output::position};
    e.options.tolerance = 1e-10;
    return with_table(e, 0.0, 0.5, loads_n);
  };
  const Simulation falls = moving_from(0.01)();  // 2 kN/m down: F = -2000 x
  REQUIRE(falls.ok());
  const double rate = std::sqrt(2000.0 / 50.0);
  const Simulation rises = moving_from(0.46)();  // 8 kN/m up: F = 8000 (x - 0.375)
  REQUIRE(rises.ok());
  const double frequency = std::sqrt(8000.0 / 50.0);
  int swings = 0;
  for (Eigen::Index i = 0; i < 31; ++i) {
    const double t = 0.01 * static_cast<double>(i);
    CHECK_THAT(falls.outputs(i, 0), WithinRel(0.01 * std::cosh(rate * t), 1e-5));
    const double swing = 0.375 + 0.085 * std::cos(frequency * t);
    if (swing < 0.325) break;  // the parabola of the corner at 0.3 begins here
    CHECK_THAT(rises.outputs(i, 0), WithinRel(swing, 1e-5));
    ++swings;
  }
  CHECK(swings > 15);
}

TEST_CASE("load_pressure: a rig with a load table follows an integrator of another kind",
          "[model]") {
  Experiment e;
  e.rig.controller = ControllerKind::none;
  e.inputs.drive = Signal::sine(5.0, 2.0);
  e.set("mass", 85.0).set("damping", 3000.0).set("stiffness", 1e4).set("leakage_coefficient", 0.0);
  e.times_s = grid(0.0, 0.6, 13);
  e.outputs = {Output::position, Output::velocity, Output::load_pressure};
  e.options.tolerance = 1e-9;
  e = with_table(e, 0.0, 0.012);
  const Simulation run = e();
  REQUIRE(run.ok());
  const ParameterValues& p = e.values;
  const double area = p["piston_area"];
  const Eigen::MatrixXd other = runge_kutta(
      std::array<double, 3>{}, e.times_s, 2000, [&](const std::array<double, 3>& x, double t) {
        const double spool = p["valve_gain"] * 5.0 * std::sin(4.0 * kPi * t);
        const double head = p["supply_pressure"] - std::copysign(x[2], spool * x[2]);
        const double flow = p["discharge_coefficient"] * p["area_gradient"] * spool *
                            rounded_root(head) / std::sqrt(p["density"]);
        const double force =
            area * x[2] - 3000.0 * x[1] - 1e4 * x[0] - load_of_ramps(x[0], 0.0, 0.012);
        return std::array<double, 3>{
            x[1], force / 85.0, 4.0 * p["bulk_modulus"] / p["total_volume"] * (flow - area * x[1])};
      });
  REQUIRE(other.col(0).maxCoeff() > 0.012);  // through the whole table
  CHECK(difference(run.outputs, other) < 2e-5);
  e.options.method = Method::dopri5;
  const Simulation explicit_run = e();
  REQUIRE(explicit_run.ok());
  CHECK(difference(explicit_run.outputs, other) < 2e-5);
}

TEST_CASE("two_chamber: a rig with a load table follows an integrator of another kind", "[model]") {
  Experiment e = proportional_rig();
  e.inputs.drive = Signal::sine(8.0, 0.8);
  e.times_s = grid(0.0, 1.4, 15);
  constexpr double kHeavier = 20.0;
  std::array<double, 6> loads_n = kLoads_n;
  for (double& load : loads_n) load *= kHeavier;
  e = with_table(e, 0.0, 0.003, loads_n);
  e.set("gravity", 9.81);
  const Simulation run = e();
  REQUIRE(run.ok());
  const Eigen::MatrixXd other = runge_kutta(
      std::array<double, 4>{0.0, 0.0, run.outputs(0, 2), run.outputs(0, 3)}, e.times_s, 8000,
      [&](const std::array<double, 4>& x, double t) {
        const double out = 8.0 * std::sin(2.0 * kPi * 0.8 * t);
        const auto edge = [](double signal, double head) {
          const double opening = 2e-6 * std::max(signal - 0.5, 0.0);
          return 0.65 * 0.02 * std::sqrt(2.0 / 870.0) * opening * rounded_root(head);
        };
        const double flow_a = edge(out, 2e7 - x[2]) - edge(-out, x[2] - 2e5);
        const double flow_b = edge(-out, 2e7 - x[3]) - edge(out, x[3] - 2e5);
        const double force = 4e-3 * x[2] - 2.4e-3 * x[3] - 4e4 * x[1] - 2000.0 * 9.81 -
                             kHeavier * load_of_ramps(x[0], 0.0, 0.003);
        return std::array<double, 4>{
            x[1], force / 2000.0, 8e8 / (1e-3 + 4e-3 * (x[0] + 0.5)) * (flow_a - 4e-3 * x[1]),
            8e8 / (1e-3 + 2.4e-3 * (0.5 - x[0])) * (flow_b + 2.4e-3 * x[1])};
      });
  REQUIRE(other.col(0).maxCoeff() > 0.003);  // through the whole table
  CHECK(difference(run.outputs, other) < 2e-5);
}

TEST_CASE("load_pressure: with a load table the second half of a period is not the first reversed",
          "[model]") {
  Experiment e;
  e.rig.controller = ControllerKind::pid;
  e.set("kp", 900.0).set("stiffness", 2e4);
  e.inputs.drive = Signal::sine(0.01, 5.0);
  e.times_s = grid(0.0, 12.0, 2401);
  e = with_table(e, -0.012, 0.012);
  const Simulation early = e();
  e.options.periodic_steady_state = false;
  const Simulation whole = e();
  REQUIRE(early.ok());
  REQUIRE(whole.ok());
  CHECK(early.steps < whole.steps / 3);  // it ends once a whole period repeats itself
  CHECK(difference(whole.outputs, early.outputs) < 1e-4);
  // Up and down differ, so half a period would not do.
  CHECK(std::abs(whole.outputs.col(1).tail(400).mean()) > 1e4);
}
