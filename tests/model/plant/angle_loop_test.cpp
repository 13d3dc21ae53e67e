// Tests loops on the angle of a joint, also against an integrator of another kind (docs/model.md,
// section 9).

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

constexpr double kAngleGain_v_per_rad = 10.0;

/// The arm with an electric valve under a proportional loop on its angle.
Experiment arm_loop(const Signal& reference) {
  Experiment e = arm_rig().unset("pilot_gain").unset("pilot_dead_band");
  e.rig.pilot = false;
  e.rig.controller = ControllerKind::pid;
  e.rig.feedback = Feedback::angle;
  e.set("valve_gain", 2e-4).set("joint_damping", 1e4).set("angle_kp", kAngleGain_v_per_rad);
  e.inputs.drive = reference;
  e.outputs = {Output::angle, Output::command};
  e.options.tolerance = 1e-9;
  return e;
}

double angle_reference(double t) { return 0.5 * std::sin(2.0 * kPi * 0.5 * t); }

}  // namespace

TEST_CASE("angle loop: a PID with inner feedback follows an integrator of another kind",
          "[model]") {
  Experiment e = own_arm(Feedback::angle);
  e.inputs.drive = Signal::sine(0.5, 0.5);
  e.set("angle_kp", kAngleGain_v_per_rad).set("angle_ki", 8.0).set("angle_kd", 0.2);
  e.set("derivative_filter", 100.0).set("pressure_feedback", 5e-8);
  e.set("gravity_moment", 4e3).set("gravity_moment_gradient", 1500.0);
  e.times_s = grid(0.0, 1.6, 17);
  e.outputs = {Output::angle,      Output::angular_velocity, Output::pressure_a,
               Output::pressure_b, Output::command,          Output::torque};
  const Simulation first = e();
  INFO(first.reason);
  REQUIRE(first.ok());
  using Point = std::array<double, 7>;  // angle, rate, pressures, spool, integral, filtered error
  const auto command = [](const Point& x, double t) {
    const double error = angle_reference(t) - x[0];
    return kAngleGain_v_per_rad * error + x[5] + 0.2 * 100.0 * (error - x[6]) -
           5e-8 * (x[2] - x[3]);
  };
  const Point start{0.0, 0.0, first.outputs(0, 2), first.outputs(0, 3), 0.0, 0.0, 0.0};
  const Eigen::MatrixXd states = runge_kutta(start, e.times_s, 1000, [&](const Point& x, double t) {
    const auto arm = own_arm_rates(x, 4e3 + 1500.0 * x[0], command(x, t));
    const double error = angle_reference(t) - x[0];
    return Point{arm[0], arm[1], arm[2], arm[3], arm[4], 8.0 * error, 100.0 * (error - x[6])};
  });
  Eigen::MatrixXd expected(states.rows(), 6);
  expected.leftCols(4) = states.leftCols(4);
  for (Eigen::Index i = 0; i < states.rows(); ++i) {
    Point x;
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = states(i, static_cast<Eigen::Index>(k));
    expected(i, 4) = command(x, e.times_s[static_cast<std::size_t>(i)]);
    expected(i, 5) = own_moment(x[0], x[2], x[3]);
  }
  REQUIRE(peak(expected.col(0)) > 0.3);
  REQUIRE(peak(expected.col(0)) < 0.9);
  check_both_methods(e, expected);
}

TEST_CASE("angle loop: a proportional loop ends off its reference by the null shift", "[model]") {
  Experiment e = arm_loop(Signal::constant(0.3));
  e.set("valve_offset", 0.4).set("gravity_moment", 4e3);
  e.times_s = {0.0, 30.0};
  const Simulation proportional = e();
  REQUIRE(proportional.ok());
  // The spool is closed where the command is the negative null shift.
  CHECK_THAT(proportional.outputs(1, 0), WithinAbs(0.3 + 0.4 / kAngleGain_v_per_rad, 1e-6));
  CHECK_THAT(proportional.outputs(1, 1), WithinAbs(-0.4, 1e-5));
  e.set("angle_ki", 5.0);
  const Simulation integral = e();
  REQUIRE(integral.ok());
  CHECK_THAT(integral.outputs(1, 0), WithinAbs(0.3, 1e-6));
  CHECK_THAT(integral.outputs(1, 1), WithinAbs(-0.4, 1e-5));
}

TEST_CASE("angle loop: a sampled loop does what one written by hand does", "[model]") {
  Experiment e = arm_loop(Signal::sine(0.5, 0.5));
  e.set("angle_ki", 8.0).set("valve_time_constant", 0.01);
  check_sampled_loop(e, angle_reference, kAngleGain_v_per_rad, 8.0, 3.0);
}

TEST_CASE("angle loop: it begins settled at its first reference, or waits at the arm's angle",
          "[model]") {
  Experiment settled = arm_loop(Signal::constant(0.25));
  settled.rig.before = Before::steady;
  settled.set("gravity_moment", 4e3);
  settled.times_s = {0.0, 1.0};
  const Simulation steady = settled();
  INFO(steady.reason);
  REQUIRE(steady.ok());
  CHECK_THAT(steady.outputs(0, 0), WithinAbs(0.25, 1e-9));
  CHECK_THAT(steady.outputs(1, 0), WithinAbs(0.25, 1e-6));
  Experiment delayed = arm_loop(Signal::constant(0.6));
  delayed.rig.before = Before::rest;
  delayed.set("reference_angle", 0.2).set("transport_delay", 0.1);
  delayed.times_s = {0.0, 0.09, 0.6};
  const Simulation waits = delayed();
  REQUIRE(waits.ok());
  CHECK_THAT(waits.outputs(1, 0), WithinAbs(0.2, 1e-8));
  CHECK_THAT(waits.outputs(1, 1), WithinAbs(0.0, 1e-6));
  CHECK(waits.outputs(2, 0) > 0.3);
}

TEST_CASE("layout_of: a loop on the angle has a filtered error in radians", "[model]") {
  const Experiment e = arm_loop(Signal::constant(0.0)).set("angle_ki", 1.0).set("angle_kd", 1.0);
  const Layout layout = layout_of(e.rig, e.values, {}, LinkagePlant::kStates);
  CHECK(layout.states == 6);
  CHECK(layout.added[1]->unit == "rad");
  CHECK(layout.motion_alone());
}
