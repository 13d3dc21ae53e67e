// Tests loops of a linkage on torque and load pressure, and the feed-forward of the reference of
// its angle, also against an integrator of another kind (docs/model.md, section 9).

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "model/plant/layout.hpp"
#include "model/plant/linkage.hpp"
#include "tests/model/both_methods.hpp"
#include "tests/model/own_arm.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

constexpr double kJointFilter_rad_per_s = 100.0;
constexpr double kInnerGain_v_per_pa = 2e-8;

struct JointLoop {
  Feedback feedback;
  Output controlled;
  double amplitude;
  double kp, ki, kd;
};
constexpr JointLoop kJointLoops[] = {
    {Feedback::torque, Output::torque, 4e3, 1e-4, 3e-4, 1e-6},
    {Feedback::load_pressure, Output::load_pressure, 3e6, 1e-7, 2e-7, 1e-9}};

double reference_of(const JointLoop& loop, double t) {
  return loop.amplitude * std::sin(2.0 * kPi * 0.5 * t);
}

/// An arm against a spring, whose controller acts on the moment or the pressures.
Experiment joint_loop(const JointLoop& loop) {
  Experiment e = own_arm(loop.feedback);
  e.set("gravity_moment_gradient", 1e5);
  e.set(gain_keys(loop.feedback).kp, loop.kp);
  e.inputs.drive = Signal::sine(loop.amplitude, 0.5);
  e.times_s = grid(0.0, 1.6, 17);
  e.outputs = {loop.controlled, Output::command};
  return e;
}

/// A vane motor against a spring, under a proportional loop on its torque.
Experiment vane_loop() {
  Experiment e = joint_loop(kJointLoops[0]).unset("area_a").unset("area_b").unset("lever");
  return e.unset("lever_gradient").set("displacement_per_radian", 1e-3);
}

double smoothed_sign(double omega) { return std::tanh(omega / 0.2); }

}  // namespace

TEST_CASE("joint loops: on torque and load pressure they follow an integrator of another kind",
          "[model]") {
  for (const JointLoop& loop : kJointLoops) {
    CAPTURE(gain_keys(loop.feedback).name);
    Experiment e = joint_loop(loop);
    e.set(gain_keys(loop.feedback).ki, loop.ki).set(gain_keys(loop.feedback).kd, loop.kd);
    e.set("derivative_filter", kJointFilter_rad_per_s);
    e.set("pressure_feedback", kInnerGain_v_per_pa);
    e.set("gravity_moment", 2e3).set("joint_friction", 600.0).set("joint_friction_smoothing", 0.2);
    e.outputs = {Output::angle,      Output::angular_velocity, Output::pressure_a,
                 Output::pressure_b, Output::command,          loop.controlled};
    const Simulation first = e();
    INFO(first.reason);
    REQUIRE(first.ok());
    using Point = std::array<double, 7>;  // ..., spool, integral, filtered error
    const auto controlled = [&](const Point& x) {
      if (loop.feedback == Feedback::load_pressure) return x[2] - x[3];
      return own_moment(x[0], x[2], x[3]) - 600.0 * smoothed_sign(x[1]);
    };
    const auto error = [&](const Point& x, double t) {
      return reference_of(loop, t) - controlled(x);
    };
    const auto command = [&](const Point& x, double t) {
      return loop.kp * error(x, t) + x[5] +
             loop.kd * kJointFilter_rad_per_s * (error(x, t) - x[6]) -
             kInnerGain_v_per_pa * (x[2] - x[3]);
    };
    const Point start{0.0, 0.0, first.outputs(0, 2), first.outputs(0, 3), 0.0, 0.0, 0.0};
    const auto rates = [&](const Point& x, double t) {
      const double load = 2e3 + 1e5 * x[0] + 600.0 * smoothed_sign(x[1]);
      const auto arm = own_arm_rates(x, load, command(x, t));
      return Point{arm[0],
                   arm[1],
                   arm[2],
                   arm[3],
                   arm[4],
                   loop.ki * error(x, t),
                   kJointFilter_rad_per_s * (error(x, t) - x[6])};
    };
    const Eigen::MatrixXd states = runge_kutta(start, e.times_s, 1000, rates);
    Eigen::MatrixXd expected(states.rows(), 6);
    expected.leftCols(4) = states.leftCols(4);
    for (Eigen::Index i = 0; i < states.rows(); ++i) {
      Point x;
      for (std::size_t k = 0; k < x.size(); ++k) x[k] = states(i, static_cast<Eigen::Index>(k));
      expected(i, 4) = command(x, e.times_s[static_cast<std::size_t>(i)]);
      expected(i, 5) = controlled(x);
    }
    REQUIRE(peak(expected.col(0)) > 0.02);
    REQUIRE(peak(expected.col(0)) < 0.9);
    REQUIRE(peak(expected.col(4)) > 0.1);
    check_both_methods(e, expected);
  }
}

TEST_CASE("joint loops: the command is the gain times what the controlled quantity lacks",
          "[model]") {
  for (const JointLoop& loop : kJointLoops) {
    const Experiment e = joint_loop(loop);
    const Simulation run = e();
    INFO(run.reason);
    REQUIRE(run.ok());
    for (Eigen::Index i = 0; i < run.outputs.rows(); ++i) {
      const double error =
          reference_of(loop, e.times_s[static_cast<std::size_t>(i)]) - run.outputs(i, 0);
      CHECK_THAT(run.outputs(i, 1), WithinAbs(loop.kp * error, 1e-9));
    }
    CHECK(peak(run.outputs.col(1)) > 0.1);
  }
}

TEST_CASE("joint loops: integral action leaves no error of torque and load pressure", "[model]") {
  for (const JointLoop& loop : kJointLoops) {
    Experiment e = joint_loop(loop);
    e.set(gain_keys(loop.feedback).ki, 2.0 * loop.kp).set("valve_offset", 0.05);
    e.inputs.drive = Signal::constant(0.5 * loop.amplitude);
    e.times_s = {0.0, 40.0};
    e.outputs = {loop.controlled, Output::angle, Output::torque};
    const Simulation run = e();
    INFO(run.reason);
    REQUIRE(run.ok());
    CAPTURE(gain_keys(loop.feedback).name);
    CHECK_THAT(run.outputs(1, 0), WithinRel(0.5 * loop.amplitude, 1e-5));
    CHECK_THAT(1e5 * run.outputs(1, 1), WithinRel(run.outputs(1, 2), 1e-5));
  }
}

TEST_CASE("joint loops: a vane motor on torque ends off its reference by the null shift",
          "[model]") {
  Experiment e = vane_loop();
  e.set("valve_offset", 0.02);
  e.inputs.drive = Signal::constant(1.5e3);
  e.times_s = {0.0, 60.0};
  e.outputs = {Output::torque, Output::angle, Output::load_pressure};
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  // The spool is closed where the command is the negative null shift.
  const double torque = 1.5e3 + 0.02 / kJointLoops[0].kp;
  CHECK_THAT(run.outputs(1, 0), WithinRel(torque, 1e-5));
  CHECK_THAT(run.outputs(1, 1), WithinRel(torque / 1e5, 1e-5));
  CHECK_THAT(run.outputs(1, 2), WithinRel(torque / 1e-3, 1e-5));
}

TEST_CASE("joint loops: before the record a loop on torque waits, or is settled", "[model]") {
  Experiment waits = joint_loop(kJointLoops[0]);
  waits.rig.before = Before::rest;
  waits.set("gravity_moment", 2e3).set("transport_delay", 0.1);
  waits.inputs.drive = Signal::constant(5e3);
  waits.times_s = {0.0, 0.09, 0.3};
  const Simulation waiting = waits();
  INFO(waiting.reason);
  REQUIRE(waiting.ok());
  CHECK_THAT(waiting.outputs(1, 0), WithinRel(2e3, 1e-6));
  CHECK_THAT(waiting.outputs(1, 1), WithinAbs(0.0, 1e-6));
  CHECK(waiting.outputs(2, 0) > 2.2e3);
  Experiment settled = joint_loop(kJointLoops[0]);
  settled.rig.before = Before::steady;
  settled.inputs.drive = Signal::constant(3e3);
  settled.times_s = {0.0, 1.0};
  const Simulation steady = settled();
  INFO(steady.reason);
  REQUIRE(steady.ok());
  CHECK_THAT(steady.outputs(0, 0), WithinRel(3e3, 1e-6));
  CHECK_THAT(steady.outputs(1, 0), WithinRel(3e3, 1e-6));
}

TEST_CASE("joint loops: a sampled loop on torque does what one written by hand does", "[model]") {
  Experiment e = joint_loop(kJointLoops[0]);
  e.set("torque_ki", 1e-3);
  check_sampled_loop(
      e, [](double t) { return reference_of(kJointLoops[0], t); }, 1e-4, 1e-3, 0.2);
}

TEST_CASE("joint loops: feed-forward of the angle follows an integrator of another kind",
          "[model]") {
  constexpr double kVelocity_v_s_per_rad = 0.6;
  constexpr double kAcceleration_v_s2_per_rad = 0.05;
  Experiment e = own_arm(Feedback::angle);
  e.set("angle_kp", 6.0).set("angle_ki", 5.0).set("derivative_filter", kJointFilter_rad_per_s);
  e.set("angular_velocity_feedforward", kVelocity_v_s_per_rad);
  e.set("angular_acceleration_feedforward", kAcceleration_v_s2_per_rad);
  e.set("gravity_moment", 4e3).set("gravity_moment_gradient", 1500.0);
  e.inputs.drive = Signal::sine(0.4, 0.5);
  e.times_s = grid(0.0, 1.6, 17);
  e.outputs = {Output::angle, Output::angular_velocity, Output::pressure_a, Output::pressure_b,
               Output::command};
  const Simulation first = e();
  INFO(first.reason);
  REQUIRE(first.ok());
  using Point = std::array<double, 8>;  // ..., spool, integral, filtered reference and its rate
  const auto reference = [](double t) { return 0.4 * std::sin(kPi * t); };
  const auto rate = [&](const Point& x, double t) {
    return kJointFilter_rad_per_s * (reference(t) - x[6]);
  };
  const auto command = [&](const Point& x, double t) {
    return 6.0 * (reference(t) - x[0]) + x[5] + kVelocity_v_s_per_rad * rate(x, t) +
           kAcceleration_v_s2_per_rad * kJointFilter_rad_per_s * (rate(x, t) - x[7]);
  };
  const Point start{0.0, 0.0, first.outputs(0, 2), first.outputs(0, 3)};
  const Eigen::MatrixXd states = runge_kutta(start, e.times_s, 1000, [&](const Point& x, double t) {
    const auto arm = own_arm_rates(x, 4e3 + 1500.0 * x[0], command(x, t));
    return Point{arm[0],     arm[1],
                 arm[2],     arm[3],
                 arm[4],     5.0 * (reference(t) - x[0]),
                 rate(x, t), kJointFilter_rad_per_s * (rate(x, t) - x[7])};
  });
  Eigen::MatrixXd expected(states.rows(), 5);
  expected.leftCols(4) = states.leftCols(4);
  for (Eigen::Index i = 0; i < states.rows(); ++i) {
    Point x;
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = states(i, static_cast<Eigen::Index>(k));
    expected(i, 4) = command(x, e.times_s[static_cast<std::size_t>(i)]);
  }
  REQUIRE(peak(expected.col(0)) > 0.2);
  REQUIRE(peak(expected.col(0)) < 0.9);
  check_both_methods(e, expected);
}

TEST_CASE("joint loops: feed-forward lessens the lag of the arm", "[model]") {
  Experiment e = own_arm(Feedback::angle);
  e.set("angle_kp", 6.0).set("derivative_filter", 300.0);
  e.inputs.drive = Signal::sine(0.3, 0.25);
  e.times_s = grid(0.0, 8.0, 161);
  e.outputs = {Output::angle};
  const auto worst = [](const Experiment& each) {
    const Simulation run = each();
    REQUIRE(run.ok());
    double largest = 0.0;
    for (std::size_t i = 80; i < each.times_s.size(); ++i)
      largest = std::max(largest, std::abs(0.3 * std::sin(0.5 * kPi * each.times_s[i]) -
                                           run.outputs(static_cast<Eigen::Index>(i), 0)));
    return largest;
  };
  const double lags_rad = worst(e);
  // Flow, lever and areas ask for 2.4 V s/rad upwards and 3.1 V s/rad downwards.
  e.set("angular_velocity_feedforward", 2.5);
  CHECK(worst(e) < 0.4 * lags_rad);
}

TEST_CASE("layout_of: loops of a linkage have states in the unit of what they control", "[model]") {
  Experiment e = joint_loop(kJointLoops[0]).set("torque_ki", 1.0).set("torque_kd", 1.0);
  const Layout torque = layout_of(e.rig, e.values, {}, LinkagePlant::kStates);
  CHECK(torque.states == 7);
  CHECK(torque.added[2]->unit == "N m");
  CHECK_FALSE(torque.motion_alone());
  e = own_arm(Feedback::angle);
  e.set("angle_kp", 1.0).set("angular_acceleration_feedforward", 1.0);
  const Layout angle = layout_of(e.rig, e.values, {}, LinkagePlant::kStates);
  CHECK(angle.states == 7);
  CHECK(angle.added[1]->unit == "rad");
  CHECK(angle.added[2]->unit == "rad/s");
  CHECK_FALSE(angle.motion_alone());
}
