// Tests the response of the spool at rest to a step of the command against closed forms, and a
// two-stage valve in a loop against an integrator of another kind (docs/model.md, section 2).

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/model/end_of_run.hpp"
#include "tests/model/runge_kutta.hpp"
#include "tests/model/two_chamber_rig.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

constexpr double kSpoolGain_m_per_v = 0.0406e-3;

/// Spool signal [V] over 20 ms after a step of 2 V.
Eigen::VectorXd stepped_spool(Experiment e) {
  e.rig.controller = ControllerKind::none;
  e.inputs.drive = Signal::constant(2.0);
  e.times_s = grid(0.0, 0.02, 21);
  e.outputs = {Output::spool};
  e.options.tolerance = 1e-9;
  const Simulation run = e();
  REQUIRE(run.ok());
  return run.outputs.col(0) / kSpoolGain_m_per_v;
}

}  // namespace

TEST_CASE("valve: a first-order lag", "[model]") {
  Experiment e;
  e.set("valve_time_constant", 4e-3);
  const auto spool_v = stepped_spool(e);
  for (int i = 0; i <= 20; ++i)
    CHECK_THAT(spool_v(i), WithinAbs(2.0 * (1.0 - std::exp(-1e-3 * i / 4e-3)), 1e-6));
}

TEST_CASE("valve: a second-order lag", "[model]") {
  const double omega = 700.0;
  for (const double zeta : {0.3, 0.8}) {
    Experiment e;
    e.set("valve_frequency", omega).set("valve_damping_ratio", zeta);
    const auto spool_v = stepped_spool(e);
    const double root = std::sqrt(1.0 - zeta * zeta);
    for (int i = 0; i <= 20; ++i) {
      const double t = 1e-3 * i;
      const double rings = std::cos(omega * root * t) + zeta / root * std::sin(omega * root * t);
      CHECK_THAT(spool_v(i), WithinAbs(2.0 * (1.0 - std::exp(-zeta * omega * t) * rings), 1e-6));
    }
  }
}

TEST_CASE("valve: a first-order lag within its rate limit", "[model]") {
  // A ramp until the lag becomes slower than the limit, at 2 V - r tau; then the exponential of the
  // lag.
  const double tau = 4e-3;
  const double rate = 200.0;
  Experiment e;
  e.set("valve_time_constant", tau).set("valve_rate_limit", rate);
  const auto spool_v = stepped_spool(e);
  const double until = 2.0 / rate - tau;
  for (int i = 0; i <= 20; ++i) {
    const double t = 1e-3 * i;
    const double expected = t < until ? rate * t : 2.0 - rate * tau * std::exp(-(t - until) / tau);
    CHECK_THAT(spool_v(i), WithinAbs(expected, 1e-5));
  }
}

TEST_CASE("valve: a main spool behind a pilot stage of first order is a second-order lag",
          "[model]") {
  const double tau = 1.5e-3;
  const double gain = 300.0;
  Experiment e;
  e.set("valve_time_constant", tau).set("main_spool_gain", gain);
  const auto spool_v = stepped_spool(e);
  const double omega = std::sqrt(gain / tau);
  const double zeta = 0.5 / std::sqrt(gain * tau);
  const double root = std::sqrt(1.0 - zeta * zeta);
  for (int i = 0; i <= 20; ++i) {
    const double t = 1e-3 * i;
    const double rings = std::cos(omega * root * t) + zeta / root * std::sin(omega * root * t);
    CHECK_THAT(spool_v(i), WithinAbs(2.0 * (1.0 - std::exp(-zeta * omega * t) * rings), 1e-6));
  }
  // A fast pilot stage leaves the integrator of the main spool alone.
  Experiment fast;
  fast.set("valve_frequency", 1e6).set("valve_damping_ratio", 1.0).set("main_spool_gain", gain);
  const auto followed_v = stepped_spool(fast);
  for (int i = 0; i <= 20; ++i)
    CHECK_THAT(followed_v(i), WithinAbs(2.0 * (1.0 - std::exp(-gain * 1e-3 * i)), 1e-3));
}

TEST_CASE("valve: a fully open pilot stage moves the main spool at its rate limit", "[model]") {
  const double tau = 1.5e-3;
  const double gain = 300.0;
  const double rate = 60.0;  // V/s: the pilot is fully open at 0.2 V
  Experiment e;
  e.set("valve_time_constant", tau).set("main_spool_gain", gain).set("valve_rate_limit", rate);
  const auto spool_v = stepped_spool(e);
  for (int i = 0; i <= 20; ++i) {
    const double t = 1e-3 * i;
    CHECK_THAT(spool_v(i), WithinAbs(rate * (t - tau * (1.0 - std::exp(-t / tau))), 1e-6));
  }
}

TEST_CASE("valve: a loop on a two-stage valve follows an integrator of another kind", "[model]") {
  Experiment e;
  e.inputs.drive = Signal::sine(0.02, 3.0);
  e.set("kp", 150.0).set("leakage_coefficient", 0.0).set("stiffness", 1e4);
  e.set("valve_frequency", 900.0).set("valve_damping_ratio", 0.6);
  e.set("main_spool_gain", 250.0).set("valve_rate_limit", 30.0);
  e.times_s = grid(0.0, 0.6, 13);
  e.outputs = {Output::position, Output::velocity, Output::load_pressure, Output::spool};
  e.options.tolerance = 1e-9;
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  using Point = std::array<double, 6>;  // with the main spool and the two states of the pilot stage
  Eigen::MatrixXd other = runge_kutta(Point{}, e.times_s, 5000, [](const Point& x, double t) {
    const double command = 150.0 * (0.02 * std::sin(6.0 * kPi * t) - x[0]);
    const double asked = std::clamp(command - x[3], -30.0 / 250.0, 30.0 / 250.0);
    const double head = 6.2e6 - std::copysign(x[2], x[3] * x[2]);
    const double flow =
        0.6 * 0.02075 * kSpoolGain_m_per_v * x[3] * rounded_root(head) / std::sqrt(847.0);
    return Point{x[1],
                 (1.62e-3 * x[2] - 1000.0 * x[1] - 1e4 * x[0]) / 85.0,
                 4.0 * 689e6 / 2.46888e-4 * (flow - 1.62e-3 * x[1]),
                 250.0 * x[4],
                 x[5],
                 900.0 * 900.0 * (asked - x[4]) - 2.0 * 0.6 * 900.0 * x[5]};
  });
  other.col(3) *= kSpoolGain_m_per_v;
  CHECK(difference(run.outputs, other.leftCols(4)) < 2e-5);
  e.options.method = Method::dopri5;
  const Simulation explicit_run = e();
  REQUIRE(explicit_run.ok());
  CHECK(difference(explicit_run.outputs, other.leftCols(4)) < 2e-5);
  // The limit acts: without it, the spool moves otherwise.
  e.set("valve_rate_limit", 1e9);
  const Simulation unlimited = e();
  REQUIRE(unlimited.ok());
  CHECK(difference(unlimited.outputs, run.outputs) > 0.05);
}

TEST_CASE("valve: a two-stage valve starts with its main spool at the command", "[model]") {
  for (const InitialState initial : {InitialState::rest, InitialState::given}) {
    Experiment e = single_rod_rig();
    e.rig.initial = initial;
    e.set("valve_frequency", 900.0).set("valve_damping_ratio", 0.6).set("main_spool_gain", 250.0);
    e.inputs.drive = Signal::constant(2.0);
    e.times_s = {0.0};
    REQUIRE(layout_of(e.rig, e.values, {}, 4).states == 7);
    const TwoChamberState state = end_of_run(e).state;
    CHECK(state[4] == (initial == InitialState::given ? 2.0 : 0.0));
    CHECK(state[5] == 0.0);
    CHECK(state[6] == 0.0);
  }
}

TEST_CASE("valve: a delayed command arrives late and changes nothing else", "[model]") {
  Experiment e;
  e.rig.controller = ControllerKind::none;
  e.inputs.drive = Signal::linear({0.0, 1.0}, {0.0, 5.0});
  e.times_s = grid(0.0, 0.5, 51);
  e.outputs = {Output::spool, Output::command};
  e.set("transport_delay", 0.037);
  const Simulation run = e();
  REQUIRE(run.ok());
  for (int i = 0; i <= 50; ++i) {
    const double expected_v = 5.0 * std::max(0.0, 0.01 * i - 0.037);
    CHECK_THAT(run.outputs(i, 1), WithinAbs(expected_v, 1e-12));
    CHECK_THAT(run.outputs(i, 0), WithinAbs(kSpoolGain_m_per_v * expected_v, 1e-15));
  }
}
