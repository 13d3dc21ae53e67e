// Tests the load at the rod: forces that vary with travel, and a second mass. Compares with exact
// solutions that were derived by hand, and with an integrator of another kind (docs/model.md).

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/model/both_methods.hpp"
#include "tests/model/runge_kutta.hpp"
#include "tests/model/two_chamber_rig.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

constexpr double kPistonArea_m2 = 1.62e-3;

/// A piston at rest at this position, with a closed valve and no leakage.
Experiment held_at(double position_m, Experiment e) {
  e.rig.controller = ControllerKind::none;
  e.rig.initial = InitialState::given;
  e.inputs.drive = Signal::constant(0.0);
  e.set("leakage_coefficient", 0.0).set("initial_position", position_m);
  e.times_s = {0.0, 2.0};
  e.outputs = {Output::position, Output::velocity, Output::load_pressure};
  e.options.tolerance = 1e-9;
  return e;
}

/// Two masses with a spring and a damper between them. A constant force pushes the first. The
/// piston is so small that its oil has no effect.
struct TwoMasses {
  double mass_kg = 85.0, payload_kg = 40.0, frequency = 60.0, ratio = 0.15, push_n = -500.0;

  Experiment operator()(Experiment e) const {
    e.rig.controller = ControllerKind::none;
    e.rig.initial = InitialState::given;
    e.inputs.drive = Signal::constant(0.0);
    e.set("mass", mass_kg).set("damping", 0.0).set("leakage_coefficient", 0.0);
    e.set("external_force", push_n);
    e.set("payload_mass", payload_kg).set("payload_frequency", frequency);
    e.set("payload_damping_ratio", ratio);
    e.times_s = grid(0.0, 0.2, 41);
    e.outputs = {Output::acceleration, Output::payload_acceleration, Output::position};
    e.options.tolerance = 1e-9;
    return e;
  }

  double payload_acceleration(double t) const {
    // r = x - x_2: r'' = -F / m - (1 + m_2 / m) (omega^2 r + 2 zeta omega r').
    const double heavier = std::sqrt(1.0 + payload_kg / mass_kg);
    const double w = frequency * heavier;
    const double z = ratio * heavier;
    const double wd = w * std::sqrt(1.0 - z * z);
    const double fade = std::exp(-z * w * t);
    const double end = -push_n / mass_kg / (w * w);
    const double r = end * (1.0 - fade * (std::cos(wd * t) + z * w / wd * std::sin(wd * t)));
    const double rate = end * fade * (w * w / wd) * std::sin(wd * t);
    return frequency * frequency * r + 2.0 * ratio * frequency * rate;
  }
};

void check_two_masses(const TwoMasses& masses, const Experiment& e) {
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  double largest = 0.0;
  for (Eigen::Index i = 0; i < run.outputs.rows(); ++i) {
    const double t = e.times_s[static_cast<std::size_t>(i)];
    const double expected = masses.payload_acceleration(t);
    CAPTURE(t);
    CHECK_THAT(run.outputs(i, 1), WithinAbs(expected, 2e-4));
    CHECK_THAT(run.outputs(i, 0),
               WithinAbs((-masses.push_n - masses.payload_kg * expected) / masses.mass_kg, 2e-4));
    largest = std::max(largest, std::abs(expected));
  }
  CHECK(largest > 5.0);
}

}  // namespace

TEST_CASE("load_pressure: a load that varies with travel is held where the record starts",
          "[model]") {
  struct Row {
    double gradient, curvature;
  };
  for (const Row& row : {Row{3e4, 0.0}, Row{-9e3, 0.0}, Row{0.0, 4e5}, Row{-9e3, -4e5}}) {
    for (const double x : {0.02, -0.03}) {
      Experiment e = held_at(x, {});
      e.set("external_force", 700.0).set("stiffness", 2e4);
      e.set("load_gradient", row.gradient).set("load_curvature", row.curvature);
      const Simulation run = e();
      REQUIRE(run.ok());
      const double load = 700.0 + 2e4 * x + row.gradient * x + row.curvature * x * x;
      CAPTURE(row.gradient, row.curvature, x);
      for (Eigen::Index i = 0; i < 2; ++i) {
        CHECK_THAT(run.outputs(i, 0), WithinAbs(x, 1e-9));
        CHECK_THAT(kPistonArea_m2 * run.outputs(i, 2), WithinRel(load, 1e-7));
      }
    }
  }
}

TEST_CASE(
    "load_pressure: under a load that varies with travel a rig follows an integrator of "
    "another kind",
    "[model]") {
  Experiment e;
  e.rig.controller = ControllerKind::none;
  e.inputs.drive = Signal::sine(6.0, 4.0);
  e.set("leakage_coefficient", 0.0).set("damping", 3000.0).set("stiffness", 1e5);
  e.set("external_force", 300.0).set("load_gradient", -2e4).set("load_curvature", 2e7);
  e.times_s = grid(0.0, 0.6, 13);
  e.outputs = {Output::position, Output::velocity, Output::load_pressure, Output::acceleration};
  using Point = std::array<double, 3>;
  const auto acceleration = [](const Point& x) {
    const double load = 300.0 - 2e4 * x[0] + 2e7 * x[0] * x[0];
    return (kPistonArea_m2 * x[2] - 3000.0 * x[1] - 1e5 * x[0] - load) / 85.0;
  };
  const Eigen::MatrixXd states =
      runge_kutta(Point{}, e.times_s, 4000, [&](const Point& x, double t) {
        const double spool = 0.0406e-3 * 6.0 * std::sin(8.0 * kPi * t);
        const double head = 6.2e6 - std::copysign(x[2], spool * x[2]);
        const double flow = 0.6 * 0.02075 * spool * rounded_root(head) / std::sqrt(847.0);
        return Point{x[1], acceleration(x),
                     4.0 * 689e6 / 2.46888e-4 * (flow - kPistonArea_m2 * x[1])};
      });
  Eigen::MatrixXd other(13, 4);
  other.leftCols(3) = states;
  for (Eigen::Index i = 0; i < 13; ++i)
    other(i, 3) = acceleration({states(i, 0), states(i, 1), states(i, 2)});
  // Both terms of the polynomial count.
  REQUIRE(peak(other.col(0)) > 3e-3);
  check_both_methods(e, other);
}

TEST_CASE("two_chamber: load, gravity and payload are held where the record starts", "[model]") {
  for (const double x : {0.02, -0.03}) {
    Experiment e = held_at(x, two_chamber_rig());
    e.set("external_force", 700.0).set("load_gradient", -9e3).set("load_curvature", 4e5);
    e.set("gravity", 9.81).set("payload_mass", 40.0).set("payload_frequency", 60.0);
    e.set("payload_damping_ratio", 0.1);
    const Simulation run = e();
    REQUIRE(run.ok());
    const double load = 700.0 - 9e3 * x + 4e5 * x * x + (85.0 + 40.0) * 9.81;
    for (Eigen::Index i = 0; i < 2; ++i) {
      CHECK_THAT(run.outputs(i, 0), WithinAbs(x, 1e-9));
      CHECK_THAT(kPistonArea_m2 * run.outputs(i, 2), WithinRel(load, 1e-7));
    }
  }
}

TEST_CASE("load_pressure: a second mass swings on its spring and damper", "[model]") {
  const TwoMasses masses;
  Experiment e;
  e.set("piston_area", 1e-8).set("initial_load_pressure", 0.0);
  check_two_masses(masses, masses(e));
  const TwoMasses other{85.0, 170.0, 200.0, 0.4, 2000.0};
  check_two_masses(other, other(e));
}

TEST_CASE("two_chamber: a second mass swings on its spring and damper", "[model]") {
  const TwoMasses masses;
  Experiment e = two_chamber_rig();
  e.set("area_a", 1e-8).set("area_b", 1e-8).set("stroke", 10.0);
  e.set("dead_volume_a", 1e-3).set("dead_volume_b", 1e-3);
  e.set("initial_pressure_a", 3e6).set("initial_pressure_b", 3e6);
  check_two_masses(masses, masses(e));
}

TEST_CASE("simulate: the acceleration is the rate of the velocity", "[model]") {
  for (Experiment e : {Experiment{}, two_chamber_rig()}) {
    e.set("payload_mass", 30.0).set("payload_frequency", 100.0).set("payload_damping_ratio", 0.1);
    e.set("valve_time_constant", 3e-3);
    e.times_s = grid(0.2, 0.201, 3);
    e.times_s.insert(e.times_s.begin(), 0.0);
    e.outputs = {Output::velocity, Output::acceleration};
    e.options.tolerance = 1e-10;
    const Simulation run = e();
    REQUIRE(run.ok());
    const double slope = (run.outputs(3, 0) - run.outputs(1, 0)) / 1e-3;
    CHECK(std::abs(slope) > 1e-3);
    CHECK_THAT(run.outputs(2, 1), WithinRel(slope, 0.02));
  }
}

TEST_CASE("simulate: without a second mass its acceleration is zero", "[model]") {
  Experiment e;
  e.outputs = {Output::payload_acceleration};
  const Simulation run = e();
  REQUIRE(run.ok());
  CHECK(peak(run.outputs) == 0.0);
}
