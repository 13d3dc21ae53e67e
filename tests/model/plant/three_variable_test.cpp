// Tests three-variable control: its reference generator against closed forms, the whole loop
// against an integrator of another kind, and a sampled one against its ticks computed step by step
// (docs/model.md, section 3).

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>

#include "tests/model/both_methods.hpp"
#include "tests/model/runge_kutta.hpp"
#include "tests/model/sensitivity.hpp"
#include "tests/model/two_chamber_rig.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

constexpr double kCorner_rad_per_s = 60.0;
constexpr double kRatio = 0.7;

/// A loop with a reference generator.
Experiment generating(Feedback feedback, Experiment e = {}) {
  e.rig.controller = ControllerKind::pid;
  e.rig.feedback = feedback;
  e.set("reference_frequency", kCorner_rad_per_s).set("reference_damping_ratio", kRatio);
  e.options.tolerance = 1e-9;
  return e;
}

/// A loop whose command consists only of the feed-forward.
Experiment generator_alone(Feedback feedback, double velocity_gain, double acceleration_gain) {
  Experiment e = generating(feedback);
  e.set("kp", 0.0).set("velocity_feedforward", velocity_gain);
  e.set("acceleration_feedforward", acceleration_gain);
  e.outputs = {Output::command};
  return e;
}

}  // namespace

TEST_CASE("three_variable: the references of a sine are those of a second-order filter",
          "[model]") {
  constexpr double kOmega = 2.0 * kPi * 6.0;
  const std::complex<double> s(0.0, kOmega);
  const std::complex<double> filter =
      1.0 / (s * s + 2.0 * kRatio * kCorner_rad_per_s * s + kCorner_rad_per_s * kCorner_rad_per_s);
  for (const auto& [feedback, amplitude, by_reference] :
       {std::tuple{Feedback::three_variable, 0.01, 3600.0},
        {Feedback::three_variable_acceleration, 5.0, 1.0}}) {
    const std::complex<double> position = amplitude * by_reference * filter;
    for (const auto& [gain, second] : {std::pair{2.0, 0.0}, {0.0, 0.3}}) {
      Experiment e = generator_alone(feedback, gain, second);
      e.inputs.drive = Signal::sine(amplitude, 6.0);
      e.times_s = grid(0.5, 1.0, 41);  // what it began with has faded
      e.times_s.insert(e.times_s.begin(), 0.0);
      const Simulation run = e();
      INFO(run.reason);
      REQUIRE(run.ok());
      for (std::size_t i = 1; i < e.times_s.size(); ++i) {
        const std::complex<double> turn = std::exp(s * e.times_s[i]);
        const double expected = std::imag((gain * s + second * s * s) * position * turn);
        CHECK_THAT(run.outputs(static_cast<Eigen::Index>(i), 0), WithinAbs(expected, 1e-6));
      }
    }
  }
}

TEST_CASE("three_variable: a constant acceleration leads the table to a place, and no further",
          "[model]") {
  Experiment e = generating(Feedback::three_variable_acceleration);
  e.set("kp", 300.0).set("ki", 3000.0).set("stiffness", 2e4);
  e.inputs.drive = Signal::constant(18.0);
  e.times_s = {0.0, 4.0};
  e.outputs = {Output::position, Output::velocity};
  const Simulation run = e();
  REQUIRE(run.ok());
  CHECK_THAT(run.outputs(1, 0), WithinRel(18.0 / 3600.0, 1e-6));
  CHECK_THAT(run.outputs(1, 1), WithinAbs(0.0, 1e-7));
}

TEST_CASE("three_variable: a loop follows an integrator of another kind", "[model]") {
  for (const Feedback feedback :
       {Feedback::three_variable, Feedback::three_variable_acceleration}) {
    const bool position = feedback == Feedback::three_variable;
    Experiment e = generating(feedback);
    const double amplitude = position ? 0.01 : 12.0;
    e.inputs.drive = Signal::sine(amplitude, 5.0);
    e.set("kp", 200.0).set("ki", 900.0).set("velocity_kp", 3.0).set("acceleration_kp", 4e-3);
    e.set("velocity_feedforward", 10.0).set("acceleration_feedforward", 0.05);
    e.set("pressure_feedback", 3e-8).set("valve_time_constant", 2e-3);
    e.set("leakage_coefficient", 0.0).set("stiffness", 1e4);
    e.times_s = grid(0.0, 0.6, 13);
    e.outputs = {Output::position, Output::velocity, Output::load_pressure, Output::command};
    const Simulation run = e();
    INFO(run.reason);
    REQUIRE(run.ok());
    using Point =
        std::array<double, 7>;  // ..., valve, integral, and the generator's position, rate
    const auto acceleration = [](const Point& x) {
      return (1.62e-3 * x[2] - 1000.0 * x[1] - 1e4 * x[0]) / 85.0;
    };
    const auto generated = [&](const Point& x, double t) {
      const double drive = amplitude * std::sin(10.0 * kPi * t) * (position ? 3600.0 : 1.0);
      return drive - 2.0 * 0.7 * 60.0 * x[6] - 3600.0 * x[5];
    };
    const auto command = [&](const Point& x, double t) {
      return 200.0 * (x[5] - x[0]) + x[4] + 3.0 * (x[6] - x[1]) +
             4e-3 * (generated(x, t) - acceleration(x)) - 3e-8 * x[2] + 10.0 * x[6] +
             0.05 * generated(x, t);
    };
    const auto rates = [&](const Point& x, double t) {
      const double head = 6.2e6 - std::copysign(x[2], x[3] * x[2]);
      const double flow = 0.6 * 0.02075 * 0.0406e-3 * x[3] * rounded_root(head) / std::sqrt(847.0);
      return Point{x[1],
                   acceleration(x),
                   4.0 * 689e6 / 2.46888e-4 * (flow - 1.62e-3 * x[1]),
                   (command(x, t) - x[3]) / 2e-3,
                   900.0 * (x[5] - x[0]),
                   x[6],
                   generated(x, t)};
    };
    const Eigen::MatrixXd states = runge_kutta(Point{}, e.times_s, 10000, rates);
    const Eigen::MatrixXd other = with_command<Point>(states, e.times_s, command);
    REQUIRE(peak(other.col(3)) > 0.5);
    REQUIRE(peak(other.col(3)) < 10.0);  // below the limit
    CHECK(difference(run.outputs, other) < 2e-5);
    e.options.method = Method::dopri5;
    const Simulation explicit_run = e();
    REQUIRE(explicit_run.ok());
    CHECK(difference(explicit_run.outputs, other) < 2e-5);
  }
}

TEST_CASE("three_variable: a sampled controller advances its generator at its ticks", "[model]") {
  constexpr double kPeriod_s = 4e-3;
  for (const Feedback feedback :
       {Feedback::three_variable, Feedback::three_variable_acceleration}) {
    const bool position = feedback == Feedback::three_variable;
    const double amplitude = position ? 0.01 : 20.0;
    Experiment e = generating(feedback, single_rod_rig());
    e.set("kp", 100.0).set("velocity_kp", 2.0).set("acceleration_kp", 1e-3);
    e.set("velocity_feedforward", 3.0).set("acceleration_feedforward", 0.05);
    e.set("sample_time", kPeriod_s);
    e.inputs.drive = Signal::sine(amplitude, 5.0);
    // At a tick, the outputs are those of the rig that the tick sees, and its new command.
    e.times_s.clear();
    for (int tick = 0; tick < 60; ++tick) e.times_s.push_back(tick * kPeriod_s);
    e.outputs = {Output::position, Output::velocity, Output::acceleration, Output::command};
    const Simulation run = e();
    INFO(run.reason);
    REQUIRE(run.ok());
    double x_r = 0.0;
    double v_r = 0.0;
    double largest = 0.0;
    for (Eigen::Index tick = 0; tick < 60; ++tick) {
      const double t = static_cast<double>(tick) * kPeriod_s;
      const double drive = amplitude * std::sin(10.0 * kPi * t) * (position ? 3600.0 : 1.0);
      // Backward Euler: (1 + 2 zeta w h + w^2 h^2) v = v_r + h (d - w^2 x_r).
      v_r = (v_r + kPeriod_s * (drive - 3600.0 * x_r)) /
            (1.0 + 2.0 * 0.7 * 60.0 * kPeriod_s + 3600.0 * kPeriod_s * kPeriod_s);
      x_r += kPeriod_s * v_r;
      const double a_r = drive - 2.0 * 0.7 * 60.0 * v_r - 3600.0 * x_r;
      const double expected = 100.0 * (x_r - run.outputs(tick, 0)) +
                              2.0 * (v_r - run.outputs(tick, 1)) +
                              1e-3 * (a_r - run.outputs(tick, 2)) + 3.0 * v_r + 0.05 * a_r;
      CAPTURE(tick);
      CHECK_THAT(run.outputs(tick, 3), WithinAbs(expected, 1e-6));
      largest = std::max(largest, std::abs(expected));
    }
    CHECK(largest > 0.5);
  }
}

TEST_CASE("three_variable: on a base that moves it controls what an accelerometer reads",
          "[model]") {
  Experiment e = generating(Feedback::three_variable, two_chamber_rig());
  e.set("kp", 100.0).set("velocity_kp", 2.0).set("acceleration_kp", 8e-3);
  e.set("valve_time_constant", 3e-3);
  e.inputs.drive = Signal::constant(0.0);
  e.inputs.base_acceleration_m_per_s2 = Signal::sine(3.0, 5.0);
  e.times_s = grid(0.0, 0.3, 31);
  e.outputs = {Output::position, Output::velocity, Output::acceleration, Output::command};
  const Simulation run = e();
  REQUIRE(run.ok());
  for (Eigen::Index i = 0; i < 31; ++i)
    CHECK_THAT(run.outputs(i, 3), WithinAbs(-100.0 * run.outputs(i, 0) - 2.0 * run.outputs(i, 1) -
                                                8e-3 * run.outputs(i, 2),
                                            1e-9));
  CHECK(peak(run.outputs.col(2)) > 1.0);
}

TEST_CASE("three_variable: a record may begin at rest, settled, or in the middle", "[model]") {
  for (const Feedback feedback :
       {Feedback::three_variable, Feedback::three_variable_acceleration}) {
    const double drive = feedback == Feedback::three_variable ? 0.004 : 0.004 * 3600.0;
    Experiment e = generating(feedback);
    e.set("kp", 300.0).set("velocity_kp", 2.0).set("acceleration_kp", 4e-3);
    e.set("leakage_coefficient", 0.0).set("initial_position", 0.004);
    e.set("valve_time_constant", 2e-3);
    e.inputs.drive = Signal::constant(drive);
    e.rig.initial = InitialState::given;
    e.times_s = grid(0.0, 0.2, 21);
    e.outputs = {Output::position, Output::command};
    for (const Before before : {Before::hold, Before::steady}) {
      e.rig.before = before;
      const Simulation run = e();
      INFO(run.reason);
      REQUIRE(run.ok());
      CHECK(peak(run.outputs.col(0).array() - 0.004) < 1e-9);
      CHECK(peak(run.outputs.col(1)) < 1e-6);
    }
    // Until the delayed step of the drive arrives, the table stays where it is.
    e.rig.before = Before::rest;
    e.inputs.drive = Signal::constant(2.0 * drive);
    e.set("transport_delay", 0.05);
    const Simulation stepped = e();
    REQUIRE(stepped.ok());
    CHECK(peak(stepped.outputs.col(0).head(6).array() - 0.004) < 1e-9);
    CHECK(stepped.outputs(20, 0) > 0.006);
  }
}

TEST_CASE("three_variable: without its corner or its damping no rig is simulated", "[model]") {
  for (const char* key : {"reference_frequency", "reference_damping_ratio"}) {
    Experiment e = generating(Feedback::three_variable);
    const auto index = static_cast<std::size_t>(parameter_index(e.rig.plant, key));
    e.values.given[index] = false;
    e.values.value[index] = 0.0;
    const Simulation run = e();
    CHECK(run.status == SimulationStatus::bad_parameters);
    CHECK_THAT(run.reason, Catch::Contains(key));
  }
}
