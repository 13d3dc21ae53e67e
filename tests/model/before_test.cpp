#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "tests/model/two_chamber_rig.hpp"

// Tests of the drive before its first sample.

using namespace rigcal::model;

namespace {

Simulation ran(const Experiment& e) {
  Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  return run;
}

/// A command that steps at the first sample, with a delay and a lag.
Experiment step_at_start() {
  Experiment e;
  e.rig.controller = ControllerKind::none;
  e.rig.initial = InitialState::given;
  e.set("initial_position", 0.01).set("transport_delay", 0.0237).set("valve_time_constant", 0.02);
  e.times_s = grid(1.7e3, 1.7e3 + 0.3, 61);
  e.inputs.drive = Signal::held({1.7e3, 1.7e3 + 0.2}, {2.0, -1.0});
  e.inputs.drive_begins_s = 1.7e3;
  return e;
}

/// Simulates the same experiment with half a second of `value` before it.
Eigen::MatrixXd with_a_past(Experiment e, double value) {
  e.rig.before = Before::hold;
  const double begin_s = e.times_s.front();
  e.times_s = grid(begin_s - 0.5, begin_s + 0.3, 161);
  e.inputs.drive =
      Signal::held({begin_s - 0.5, begin_s, begin_s + 0.2},
                   {value, e.inputs.drive.value(begin_s), e.inputs.drive.value(begin_s + 0.2)});
  return ran(e).outputs.bottomRows(61);
}

}  // namespace

TEST_CASE("before: at rest, a record may begin at its command step", "[model]") {
  Experiment e = step_at_start();
  const Eigen::MatrixXd held = ran(e).outputs;
  e.rig.before = Before::rest;
  const Simulation run = ran(e);
  CHECK(difference(run.outputs, with_a_past(e, 0.0)) < 1e-4);
  // With `hold` the valve is open at the first sample, so the piston moves before the delay is
  // over.
  CHECK(std::abs(held(4, 0) - 0.01) > 5e-4);
  CHECK(std::abs(run.outputs(4, 0) - 0.01) < 1e-9);
}

TEST_CASE("before: at rest, a loop waits for its reference where the piston is", "[model]") {
  Experiment e = step_at_start();
  e.rig.controller = ControllerKind::pid;
  e.rig.before = Before::rest;
  e.set("kp", 200.0).set("position_offset", 2e-3);
  e.inputs.drive = Signal::held({1.7e3, 1.7e3 + 0.2}, {0.02, 0.0});
  CHECK(difference(ran(e).outputs, with_a_past(e, 0.008)) < 1e-4);
}

TEST_CASE("before: a generated drive waits too, longer than its period", "[model]") {
  Experiment e;
  e.set("kp", 300.0).set("transport_delay", 0.31);
  e.inputs.drive = Signal::sine(0.01, 10.0);
  e.rig.before = Before::rest;
  e.times_s = grid(0.0, 1.5, 301);
  const Eigen::MatrixXd x = ran(e).outputs.col(0);
  CHECK(peak(x.topRows(62)) == 0.0);
  CHECK(peak(x.bottomRows(100)) > 5e-4);
}

TEST_CASE("before: a loop that had settled is where a long wait at its first reference leads",
          "[model]") {
  for (const bool sampled : {false, true}) {
    CAPTURE(sampled);
    Experiment e;
    e.set("kp", 300.0).set("ki", 2000.0).set("kd", 0.5).set("derivative_filter", 300.0);
    e.set("external_force", 500.0).set("valve_frequency", 400.0).set("valve_damping_ratio", 0.8);
    if (sampled) e.set("sample_time", 0.002);
    e.inputs.drive = Signal::constant(0.013);
    e.outputs.assign(kAllOutputs.begin(), kAllOutputs.end());
    e.times_s = {0.0, 20.0};
    e.options.tolerance = 1e-9;
    const Eigen::MatrixXd late = ran(e).outputs.bottomRows(1);
    e.rig.before = Before::steady;
    e.times_s = grid(0.0, 0.1, 11);
    const Eigen::MatrixXd all = ran(e).outputs;
    for (Eigen::Index k = 0; k < all.cols(); ++k) {
      CAPTURE(output_name(e.outputs[static_cast<std::size_t>(k)]));
      const double scale = std::max(std::abs(late(0, k)), 1e-6);
      for (Eigen::Index i = 0; i < all.rows(); ++i)
        CHECK(std::abs(all(i, k) - late(0, k)) < 1e-5 * scale);
    }
  }
}

TEST_CASE("before: an open loop that had settled goes on at its speed from where it is",
          "[model]") {
  Experiment e = single_rod_rig();
  e.set("supply_resistance", 2e10).set("supply_capacity", 5e-12);
  e.set("hose_capacity_a", 3e-13).set("hose_capacity_b", 2e-13).set("hose_yield", 6e5);
  e.set("coulomb_friction", 30.0).set("friction_smoothing", 0.02);
  e.set("initial_position", -0.03).set("valve_offset", 0.1);
  e.rig.initial = InitialState::given;
  e.outputs = {Output::position, Output::velocity, Output::pressure_a, Output::pressure_b};
  e.inputs.drive = Signal::constant(1.5);
  e.times_s = grid(0.0, 0.2, 21);
  e.rig.before = Before::steady;
  const Eigen::MatrixXd all = ran(e).outputs;
  CHECK(all(0, 0) == -0.03);
  CHECK(all(0, 1) > 0.01);
  for (Eigen::Index k = 1; k < all.cols(); ++k)
    CHECK(peak(all.col(k).array() - all(0, k)) < 1e-3 * std::abs(all(0, k)));
  e.rig.before = Before::hold;
  CHECK(ran(e).outputs(0, 1) == 0.0);
}

TEST_CASE("before: a rig that runs away settles nowhere, and says so", "[model]") {
  Experiment e;
  e.rig.controller = ControllerKind::pid;
  e.rig.before = Before::steady;
  e.set("kp", 300.0).set("ki", 2000.0).set("output_limit", 0.5).set("external_force", 2e4);
  const Simulation run = e();
  CHECK(run.status == SimulationStatus::no_equilibrium);
  CHECK(run.outputs.size() == 0);
  CHECK(run.reason.find("does not settle") != std::string::npos);
}
