// Tests the feed-forward of a position loop's reference: against closed forms for a sine, the whole
// loop against an integrator of another kind, and against the ticks of a sampled controller
// computed step by step (docs/model.md, section 3).

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <vector>

#include "model/plant/layout.hpp"
#include "tests/model/both_methods.hpp"
#include "tests/model/runge_kutta.hpp"
#include "tests/model/sensitivity.hpp"
#include "tests/model/two_chamber_rig.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

constexpr double kFilter_rad_per_s = 200.0;
constexpr double kOmega_rad_per_s = 2.0 * kPi * 3.0;

/// A loop whose command consists only of the feed-forward.
Experiment fed_forward() {
  Experiment e;
  e.set("kp", 0.0).set("derivative_filter", kFilter_rad_per_s);
  e.inputs.drive = Signal::sine(0.01, 3.0);
  e.times_s = grid(1.0 / 3.0, 1.0, 41);
  e.times_s.insert(e.times_s.begin(), 0.0);
  e.outputs = {Output::command};
  e.options.tolerance = 1e-9;
  return e;
}

}  // namespace

TEST_CASE("feedforward: of a sine it is the filtered derivative", "[model]") {
  const double ratio = kOmega_rad_per_s / kFilter_rad_per_s;
  const double lag = std::atan(ratio);
  const double filtered = 1.0 / std::sqrt(1.0 + ratio * ratio);
  const double rate = 0.01 * kOmega_rad_per_s * filtered;
  const double acceleration = -rate * kOmega_rad_per_s * filtered;
  for (const auto& [gain, second_gain] : {std::pair{3.0, 0.0}, {0.0, 0.2}, {2.0, -0.1}}) {
    Experiment e = fed_forward();
    if (gain != 0.0) e.set("velocity_feedforward", gain);
    if (second_gain != 0.0) e.set("acceleration_feedforward", second_gain);
    const Simulation run = e();
    INFO(run.reason);
    REQUIRE(run.ok());
    for (std::size_t i = 1; i < e.times_s.size(); ++i) {
      const double phase = kOmega_rad_per_s * e.times_s[i];
      const double expected = gain * rate * std::cos(phase - lag) +
                              second_gain * acceleration * std::sin(phase - 2.0 * lag);
      CHECK_THAT(run.outputs(static_cast<Eigen::Index>(i), 0), WithinAbs(expected, 1e-6));
    }
  }
}

TEST_CASE("feedforward: a loop follows an integrator of another kind", "[model]") {
  Experiment e;
  e.set("kp", 100.0).set("ki", 500.0).set("kd", 0.3).set("derivative_filter", 250.0);
  e.set("velocity_feedforward", 20.0).set("acceleration_feedforward", 0.08);
  e.set("valve_time_constant", 2e-3).set("leakage_coefficient", 0.0).set("stiffness", 1e4);
  e.inputs.drive = Signal::sine(0.008, 5.0);
  e.times_s = grid(0.0, 0.6, 13);
  e.outputs = {Output::position, Output::velocity, Output::load_pressure, Output::command};
  // ..., load pressure, valve, integral, filtered error, filtered reference, its filtered rate
  using Point = std::array<double, 8>;
  const auto reference = [](double t) { return 0.008 * std::sin(10.0 * kPi * t); };
  const auto rate = [&](const Point& x, double t) { return 250.0 * (reference(t) - x[6]); };
  const auto command = [&](const Point& x, double t) {
    const double error = reference(t) - x[0];
    return 100.0 * error + x[4] + 0.3 * 250.0 * (error - x[5]) + 20.0 * rate(x, t) +
           0.08 * 250.0 * (rate(x, t) - x[7]);
  };
  const auto rates = [&](const Point& x, double t) {
    const double head = 6.2e6 - std::copysign(x[2], x[3] * x[2]);
    const double flow = 0.6 * 0.02075 * 0.0406e-3 * x[3] * rounded_root(head) / std::sqrt(847.0);
    const double error = reference(t) - x[0];
    return Point{x[1],
                 (1.62e-3 * x[2] - 1000.0 * x[1] - 1e4 * x[0]) / 85.0,
                 4.0 * 689e6 / 2.46888e-4 * (flow - 1.62e-3 * x[1]),
                 (command(x, t) - x[3]) / 2e-3,
                 500.0 * error,
                 250.0 * (error - x[5]),
                 rate(x, t),
                 250.0 * (rate(x, t) - x[7])};
  };
  const Eigen::MatrixXd states = runge_kutta(Point{}, e.times_s, 4000, rates);
  const Eigen::MatrixXd other = with_command<Point>(states, e.times_s, command);
  REQUIRE(peak(other.col(3)) > 1.0);
  REQUIRE(peak(other.col(3)) < 10.0);  // below the limit
  check_both_methods(e, other);
}

TEST_CASE("feedforward: a sampled controller takes it at its ticks", "[model]") {
  Experiment e = fed_forward();
  constexpr double kPeriod_s = 4e-3;
  e.set("velocity_feedforward", 3.0).set("acceleration_feedforward", 0.05);
  e.set("sample_time", kPeriod_s);
  e.times_s.clear();
  for (int tick = 0; tick < 60; ++tick) e.times_s.push_back((tick + 0.5) * kPeriod_s);
  e.inputs.drive_begins_s = 0.0;
  e.times_s.insert(e.times_s.begin(), 0.0);
  const Simulation run = e();
  REQUIRE(run.ok());
  const double step = kFilter_rad_per_s * kPeriod_s;
  double filtered = 0.0;
  double filtered_rate = 0.0;
  for (int tick = 0; tick < 60; ++tick) {
    const double reference = 0.01 * std::sin(kOmega_rad_per_s * tick * kPeriod_s);
    filtered = (filtered + step * reference) / (1.0 + step);
    const double rate = kFilter_rad_per_s * (reference - filtered);
    filtered_rate = (filtered_rate + step * rate) / (1.0 + step);
    const double expected = 3.0 * rate + 0.05 * kFilter_rad_per_s * (rate - filtered_rate);
    CHECK_THAT(run.outputs(tick + 1, 0), WithinAbs(expected, 1e-9));
  }
}

TEST_CASE(
    "feedforward: with the gain of the valve the piston follows without "
    "lagging",
    "[model]") {
  Experiment e;
  e.set("kp", 100.0).set("leakage_coefficient", 0.0).set("stiffness", 0.0).set("damping", 100.0);
  e.inputs.drive = Signal::sine(0.01, 0.5);
  e.times_s = grid(0.0, 4.0, 401);
  e.outputs = {Output::position};
  const auto worst = [](const Experiment& each) {
    const Simulation run = each();
    REQUIRE(run.ok());
    double largest = 0.0;
    for (std::size_t i = 200; i < each.times_s.size(); ++i)
      largest = std::max(largest, std::abs(0.01 * std::sin(kPi * each.times_s[i]) -
                                           run.outputs(static_cast<Eigen::Index>(i), 0)));
    return largest;
  };
  const double lagging_m = worst(e);
  // Volts per speed for a piston without load.
  const double flow_per_volt = e.values["valve_gain"] * e.values["discharge_coefficient"] *
                               e.values["area_gradient"] *
                               std::sqrt(e.values["supply_pressure"] / e.values["density"]);
  e.set("derivative_filter", 500.0);
  e.set("velocity_feedforward", e.values["piston_area"] / flow_per_volt);
  CHECK(worst(e) < 0.05 * lagging_m);
}

TEST_CASE("feedforward: a record that begins in motion begins without a kick", "[model]") {
  Experiment e = single_rod_rig();
  e.rig.controller = ControllerKind::pid;
  e.rig.initial = InitialState::given;
  e.set("kp", 100.0).set("derivative_filter", 300.0).set("velocity_feedforward", 20.0);
  e.set("acceleration_feedforward", 1.0).set("initial_position", 0.01);
  e.inputs.drive = Signal::constant(0.012);
  e.times_s = {0.0, 0.1};
  e.outputs = {Output::command};
  const Simulation run = e();
  REQUIRE(run.ok());
  CHECK_THAT(run.outputs(0, 0), WithinRel(100.0 * 0.002, 1e-9));
}

TEST_CASE("feedforward: sensitivities are exact against differences", "[model]") {
  const NamedValues values{{"velocity_feedforward", 20.0}, {"acceleration_feedforward", 0.3},
                           {"derivative_filter", 300.0},   {"ki", 2000.0},
                           {"transport_delay", 3e-3},      {"valve_time_constant", 2e-3}};
  NamedValues sampled = values;
  sampled.emplace_back("sample_time", 2e-3);
  for (const NamedValues& each : {values, sampled}) {
    std::set<int> seen;
    const Scenario scenario{"fed forward", Signal::sine(0.01, 9.0), each};
    check_sensitivities(experiment(scenario), seen);
    for (const char* key : {"velocity_feedforward", "acceleration_feedforward", "derivative_filter",
                            "transport_delay"})
      CHECK(seen.count(parameter_index(PlantKind::load_pressure, key)) == 1);
  }
}
