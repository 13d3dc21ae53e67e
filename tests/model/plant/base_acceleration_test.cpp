// Tests a base that moves: inertia of both masses in its frame, accelerometers that read the motion
// relative to the ground, and an integrator of another kind (docs/model.md).

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/model/runge_kutta.hpp"
#include "tests/model/sensitivity.hpp"
#include "tests/model/two_chamber_rig.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

constexpr double kShake = 4.0;  ///< amplitude of the base's acceleration [m/s2]

/// A free mass on a spring: the piston is so small that its oil has no effect.
Experiment sprung(Experiment e) {
  e.rig.controller = ControllerKind::none;
  e.rig.initial = InitialState::given;
  e.inputs.drive = Signal::constant(0.0);
  e.inputs.base_acceleration_m_per_s2 = Signal::sine(kShake, 2.0);
  e.set("mass", 50.0).set("damping", 0.0).set("stiffness", 2e4).set("leakage_coefficient", 0.0);
  e.times_s = grid(0.0, 0.9, 46);
  e.outputs = {Output::position, Output::velocity, Output::acceleration};
  e.options.tolerance = 1e-10;
  return e;
}

Experiment small_load_pressure() {
  Experiment e;
  e.set("piston_area", 1e-8).set("initial_load_pressure", 0.0);
  return sprung(e);
}

Experiment small_two_chamber() {
  Experiment e = two_chamber_rig();
  e.set("area_a", 1e-8).set("area_b", 1e-8).set("stroke", 10.0);
  e.set("dead_volume_a", 1e-3).set("dead_volume_b", 1e-3);
  e.set("initial_pressure_a", 3e6).set("initial_pressure_b", 3e6);
  return sprung(e);
}

}  // namespace

TEST_CASE("simulate: on a base that shakes a mass on a spring swings as its equation says",
          "[model]") {
  for (const Experiment& e : {small_load_pressure(), small_two_chamber()}) {
    const Simulation run = e();
    INFO(run.reason);
    REQUIRE(run.ok());
    // x'' + w^2 x = -a sin(W t), from rest
    const double w = std::sqrt(2e4 / 50.0);
    const double W = 4.0 * kPi;
    const double size = -kShake / (w * w - W * W);
    for (Eigen::Index i = 0; i < run.outputs.rows(); ++i) {
      const double t = e.times_s[static_cast<std::size_t>(i)];
      const double x = size * (std::sin(W * t) - W / w * std::sin(w * t));
      CAPTURE(t);
      CHECK_THAT(run.outputs(i, 0), WithinAbs(x, 1e-6));
      CHECK_THAT(run.outputs(i, 1),
                 WithinAbs(size * W * (std::cos(W * t) - std::cos(w * t)), 2e-5));
      // An accelerometer on the mass feels the force of the spring alone.
      CHECK_THAT(run.outputs(i, 2), WithinAbs(-w * w * x, 5e-4));
    }
    CHECK(peak(run.outputs.col(0)) > 0.02);
  }
}

TEST_CASE("simulate: a rig that falls with its base feels no forces", "[model]") {
  // Both masses are pushed alike: the second stays where it is relative to the first.
  Experiment e = small_load_pressure();
  e.set("stiffness", 0.0).set("payload_mass", 20.0).set("payload_frequency", 50.0);
  e.set("payload_damping_ratio", 0.1);
  e.inputs.base_acceleration_m_per_s2 = Signal::constant(-3.0);
  e.outputs = {Output::position, Output::acceleration, Output::payload_acceleration};
  const Simulation run = e();
  REQUIRE(run.ok());
  for (Eigen::Index i = 0; i < run.outputs.rows(); ++i) {
    const double t = e.times_s[static_cast<std::size_t>(i)];
    CHECK_THAT(run.outputs(i, 0), WithinAbs(0.5 * 3.0 * t * t, 1e-5));
    CHECK_THAT(run.outputs(i, 1), WithinAbs(0.0, 1e-3));
    CHECK_THAT(run.outputs(i, 2), WithinAbs(0.0, 1e-3));
  }
}

TEST_CASE("simulate: a constant acceleration of the base is a weight", "[model]") {
  Experiment still = two_chamber_rig();
  still.set("gravity", 2.5).set("stiffness", 1e4);
  still.options.tolerance = 1e-9;
  Experiment moving = still;
  moving.set("gravity", 0.0);
  moving.inputs.base_acceleration_m_per_s2 = Signal::constant(2.5);
  const Simulation a = still();
  const Simulation b = moving();
  REQUIRE(a.ok());
  REQUIRE(b.ok());
  CHECK(difference(a.outputs, b.outputs) < 1e-9);
}

TEST_CASE("simulate: a loop on acceleration controls what an accelerometer reads", "[model]") {
  constexpr double kGain = 9e-3;
  Experiment e = two_chamber_rig();
  e.rig.feedback = Feedback::acceleration;
  e.set("acceleration_kp", kGain).set("valve_time_constant", 3e-3);
  e.inputs.drive = Signal::constant(0.0);
  e.inputs.base_acceleration_m_per_s2 = Signal::sine(3.0, 5.0);
  e.times_s = grid(0.15, 0.1502, 3);
  e.times_s.insert(e.times_s.begin(), 0.0);
  e.outputs = {Output::velocity, Output::acceleration, Output::command};
  e.options.tolerance = 1e-10;
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  const double base = 3.0 * std::sin(10.0 * kPi * 0.1501);
  const double relative = (run.outputs(3, 0) - run.outputs(1, 0)) / 2e-4;
  CHECK_THAT(run.outputs(2, 1), WithinRel(relative + base, 0.01));
  CHECK(std::abs(base) > 1.0);
  for (Eigen::Index i = 0; i < 4; ++i)
    CHECK_THAT(run.outputs(i, 2), WithinAbs(-kGain * run.outputs(i, 1), 1e-12));
}

TEST_CASE("two_chamber: on a base that moves, all masses follow an integrator of another kind",
          "[model]") {
  Experiment e = proportional_rig();
  const auto base = Signal::linear({0.0, 0.4, 0.8, 1.4}, {0.0, 3.0, -4.0, 1.0});
  const auto base_at = [](double t) {
    if (t < 0.4) return 7.5 * t;
    if (t < 0.8) return 3.0 - 17.5 * (t - 0.4);
    return -4.0 + 5.0 / 0.6 * (t - 0.8);
  };
  e.inputs.drive = Signal::sine(8.0, 0.8);
  e.inputs.base_acceleration_m_per_s2 = base;
  e.set("payload_mass", 600.0).set("payload_frequency", 12.0).set("payload_damping_ratio", 0.05);
  e.set("external_force", 500.0).set("gravity", 9.81);
  e.times_s = grid(0.0, 1.4, 15);
  e.outputs.push_back(Output::payload_acceleration);
  const Simulation run = e();
  REQUIRE(run.ok());
  using Point = std::array<double, 6>;
  const auto rates = [&](const Point& x, double t) {
    const double out = 8.0 * std::sin(2.0 * kPi * 0.8 * t);
    const auto edge = [](double signal, double head) {
      const double opening = 2e-6 * std::max(signal - 0.5, 0.0);
      return 0.65 * 0.02 * std::sqrt(2.0 / 870.0) * opening * rounded_root(head);
    };
    const double flow_a = edge(out, 2e7 - x[2]) - edge(-out, x[2] - 2e5);
    const double flow_b = edge(-out, 2e7 - x[3]) - edge(out, x[3] - 2e5);
    const double coupling = 144.0 * (x[0] - x[4]) + 1.2 * (x[1] - x[5]);  // per payload mass
    const double force = 4e-3 * x[2] - 2.4e-3 * x[3] - 4e4 * x[1] - 500.0 - 2600.0 * 9.81 -
                         600.0 * coupling - 2000.0 * base_at(t);
    return Point{x[1],
                 force / 2000.0,
                 8e8 / (1e-3 + 4e-3 * (x[0] + 0.5)) * (flow_a - 4e-3 * x[1]),
                 8e8 / (1e-3 + 2.4e-3 * (0.5 - x[0])) * (flow_b + 2.4e-3 * x[1]),
                 x[5],
                 coupling - base_at(t)};
  };
  const Eigen::MatrixXd states = runge_kutta(
      Point{0.0, 0.0, run.outputs(0, 2), run.outputs(0, 3), 0.0, 0.0}, e.times_s, 8000, rates);
  Eigen::MatrixXd other(15, 5);
  other.leftCols(4) = states.leftCols(4);
  for (int i = 0; i < 15; ++i) {
    Point x;
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = states(i, static_cast<Eigen::Index>(k));
    other(i, 4) = rates(x, 0.1 * i)[5] + base_at(0.1 * i);
  }
  REQUIRE(peak(other.col(4)) > 1.0);
  CHECK(difference(run.outputs, other) < 2e-5);
  e.options.method = Method::dopri5;
  const Simulation explicit_run = e();
  REQUIRE(explicit_run.ok());
  CHECK(difference(explicit_run.outputs, other) < 2e-5);
}

TEST_CASE("simulate: sensitivities on a base that moves are exact against differences", "[model]") {
  std::set<int> seen;
  Experiment e = single_rod_rig();
  e.inputs.base_acceleration_m_per_s2 = Signal::linear({0.0, 0.05, 0.1}, {0.0, 6.0, -8.0});
  e = experiment(
      {"base",
       Signal::sine(2.0, 10.0),
       {{"payload_mass", 3.0}, {"payload_frequency", 150.0}, {"payload_damping_ratio", 0.2}},
       ControllerKind::none},
      e);
  check_sensitivities(e, seen, {{Output::load_pressure, 4.4e6}, {Output::force, 900.0}});
  for (const char* key : {"mass", "payload_mass", "payload_frequency", "payload_damping_ratio"})
    CHECK(seen.count(parameter_index(PlantKind::two_chamber, key)) == 1);
}
