// Tests the response of the spool at rest to a step of the command against closed forms.

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/model/rig.hpp"

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
