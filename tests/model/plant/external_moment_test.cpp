// Tests a recorded moment as a load of a joint: closed forms, an integrator of another kind and
// differences (docs/model.md, section 9).

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <vector>

#include "tests/model/both_methods.hpp"
#include "tests/model/own_arm.hpp"
#include "tests/model/sensitivity.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

/// A moment that rises and falls along straight lines [N m].
Signal recorded_moment() { return Signal::linear({0.0, 0.4, 0.8, 1.6}, {0.0, 6e3, -8e3, 2e3}); }

double recorded_moment_at(double t) {
  if (t < 0.4) return 1.5e4 * t;
  if (t < 0.8) return 6e3 - 3.5e4 * (t - 0.4);
  return -8e3 + 1.25e4 * (t - 0.8);
}

/// An arm on a spring, whose cylinder is so small that its oil has no effect.
Experiment sprung_arm() {
  Experiment e = arm_rig();
  e.rig.initial = InitialState::given;
  e.set("area_a", 1e-8).set("area_b", 1e-8).set("joint_damping", 0.0);
  e.set("gravity_moment_gradient", 4e4);
  e.set("initial_pressure_a", 3e6).set("initial_pressure_b", 3e6);
  e.inputs.drive = Signal::constant(0.0);
  e.times_s = grid(0.0, 0.9, 46);
  e.outputs = {Output::angle, Output::angular_velocity};
  e.options.tolerance = 1e-10;
  return e;
}

Experiment loaded_vane() {
  Experiment e = arm_rig().unset("area_a").unset("area_b").unset("lever");
  e.set("displacement_per_radian", 1.2e-3);
  e.inputs.drive = Signal::constant(0.0);
  return e;
}

}  // namespace

TEST_CASE("linkage: under a recorded moment an arm on a spring swings as its equation says",
          "[model]") {
  Experiment e = sprung_arm();
  e.inputs.external_load = Signal::sine(2e3, 2.0);
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  // theta'' + w^2 theta = -M sin(W t) / J, from rest
  const double w = std::sqrt(4e4 / 400.0);
  const double W = 4.0 * kPi;
  const double size = -2e3 / 400.0 / (w * w - W * W);
  for (Eigen::Index i = 0; i < run.outputs.rows(); ++i) {
    const double t = e.times_s[static_cast<std::size_t>(i)];
    CAPTURE(t);
    CHECK_THAT(run.outputs(i, 0),
               WithinAbs(size * (std::sin(W * t) - W / w * std::sin(w * t)), 1e-6));
    CHECK_THAT(run.outputs(i, 1), WithinAbs(size * W * (std::cos(W * t) - std::cos(w * t)), 2e-5));
  }
  CHECK(peak(run.outputs.col(0)) > 0.05);
}

TEST_CASE("linkage: a recorded moment turns a free arm by its integral", "[model]") {
  // The moment jumps from sample to sample.
  Experiment e = sprung_arm();
  e.set("gravity_moment_gradient", 0.0);
  e.inputs.external_load = Signal::held({0.0, 0.3, 0.6}, {400.0, -800.0, 0.0});
  e.times_s = {0.0, 0.3, 0.6, 0.9};
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  CHECK_THAT(run.outputs(1, 0), WithinAbs(-0.045, 1e-6));
  CHECK_THAT(run.outputs(1, 1), WithinAbs(-0.3, 1e-5));
  CHECK_THAT(run.outputs(2, 0), WithinAbs(-0.045, 1e-6));
  CHECK_THAT(run.outputs(2, 1), WithinAbs(0.3, 1e-5));
  CHECK_THAT(run.outputs(3, 0), WithinAbs(0.045, 1e-6));
}

TEST_CASE("linkage: a constant recorded moment is a gravity moment", "[model]") {
  for (const InitialState initial : {InitialState::rest, InitialState::given}) {
    Experiment weight = own_arm(Feedback::angle);
    weight.rig.initial = initial;
    weight.set("angle_kp", 6.0).set("gravity_moment", 3e3).set("gravity_moment_gradient", 1e3);
    if (initial == InitialState::given) weight.set("initial_pressure_a", 8e6);
    weight.inputs.drive = Signal::sine(0.3, 0.5);
    weight.times_s = grid(0.0, 1.6, 17);
    weight.outputs = {Output::angle, Output::pressure_a, Output::pressure_b, Output::torque};
    Experiment recorded = weight;
    recorded.set("gravity_moment", 500.0).inputs.external_load = Signal::constant(2.5e3);
    const Simulation a = weight();
    const Simulation b = recorded();
    REQUIRE(a.ok());
    REQUIRE(b.ok());
    CHECK(difference(a.outputs, b.outputs) < 1e-7);
    Experiment without = recorded;
    without.inputs.external_load.reset();
    CHECK(difference(without().outputs, b.outputs) > 1e-3);
  }
}

TEST_CASE("linkage: at rest the pressures carry the moment at the first sample", "[model]") {
  for (Experiment e : {arm_rig(), loaded_vane()}) {
    e.inputs.drive = Signal::constant(0.0);
    e.inputs.external_load = Signal::linear({0.0, 1.0}, {2.4e3, 2.4e3});
    e.set("gravity_moment", 600.0);
    e.times_s = {0.0, 2.0};
    e.outputs = {Output::torque, Output::angle, Output::load_pressure};
    const Simulation run = e();
    INFO(run.reason);
    REQUIRE(run.ok());
    for (const Eigen::Index i : {0, 1}) {
      CHECK_THAT(run.outputs(i, 0), WithinRel(3e3, 1e-6));
      CHECK_THAT(run.outputs(i, 1), WithinAbs(0.0, 1e-6));
    }
    if (e.values.is_given("displacement_per_radian"))
      CHECK_THAT(run.outputs(0, 2), WithinRel(3e3 / 1.2e-3, 1e-6));
  }
}

TEST_CASE("linkage: loops under a recorded moment follow an integrator of another kind",
          "[model]") {
  for (const Feedback feedback : {Feedback::angle, Feedback::torque}) {
    const bool torque = feedback == Feedback::torque;
    const double gain = torque ? 1e-4 : 6.0;
    const double amplitude = torque ? 4e3 : 0.4;
    CAPTURE(gain_keys(feedback).name);
    Experiment e = own_arm(feedback);
    e.set(gain_keys(feedback).kp, gain);
    e.set("gravity_moment", 2e3).set("gravity_moment_gradient", torque ? 1e5 : 1500.0);
    e.inputs.drive = Signal::sine(amplitude, 0.5);
    e.inputs.external_load = recorded_moment();
    e.times_s = grid(0.0, 1.6, 17);  // with the kinks of the moment
    e.outputs = {Output::angle, Output::angular_velocity, Output::pressure_a, Output::pressure_b,
                 Output::torque};
    const Simulation first = e();
    INFO(first.reason);
    REQUIRE(first.ok());
    using Point = std::array<double, 5>;
    const Point start{0.0, 0.0, first.outputs(0, 2), first.outputs(0, 3), 0.0};
    const auto rates = [&](const Point& x, double t) {
      const double controlled = torque ? own_moment(x[0], x[2], x[3]) : x[0];
      const double reference = amplitude * std::sin(kPi * t);
      const double load = 2e3 + (torque ? 1e5 : 1500.0) * x[0] + recorded_moment_at(t);
      return own_arm_rates(x, load, gain * (reference - controlled));
    };
    const Eigen::MatrixXd states = runge_kutta(start, e.times_s, 1000, rates);
    Eigen::MatrixXd expected(states.rows(), 5);
    expected.leftCols(4) = states.leftCols(4);
    for (Eigen::Index i = 0; i < states.rows(); ++i)
      expected(i, 4) = own_moment(states(i, 0), states(i, 2), states(i, 3));
    REQUIRE(peak(expected.col(0)) > 0.02);
    REQUIRE(peak(expected.col(0)) < 0.9);
    check_both_methods(e, expected);
  }
}

TEST_CASE("linkage: sensitivities under a recorded moment are exact against differences",
          "[model]") {
  std::set<int> seen;
  Scenario scenario{"recorded moment",
                    Signal::constant(2.6e6),
                    {{"lever_gradient", 0.05},
                     {"gravity_moment", 6e3},
                     {"gravity_moment_gradient", 2e4},
                     {"initial_angle", 0.1},
                     {"initial_angular_velocity", 0.3},
                     {"initial_pressure_a", 8e6}},
                    ControllerKind::none,
                    InitialState::given};
  Experiment e = experiment(scenario, arm_rig());
  e.inputs.external_load = Signal::linear({0.0, 0.05, 0.1}, {0.0, 4e3, -6e3});
  check_sensitivities(e, seen);
  for (const char* key : {"inertia", "joint_damping", "lever", "lever_gradient", "gravity_moment",
                          "gravity_moment_gradient", "area_a", "bulk_modulus"})
    CHECK(seen.count(parameter_index(PlantKind::linkage, key)) == 1);
  // A missing pressure balances the moment too, and has a sensitivity by it.
  scenario.values.pop_back();
  Experiment balanced = experiment(scenario, arm_rig());
  balanced.inputs.external_load = Signal::linear({0.0, 0.1}, {3e3, -2e3});
  check_sensitivities(balanced, seen);
}
