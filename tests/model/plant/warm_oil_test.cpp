// Tests oil that follows its temperature: against rigs whose values were changed by hand, and with
// a recorded temperature against an integrator of another kind (docs/model.md, section 2).

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "tests/model/linkage_rig.hpp"
#include "tests/model/runge_kutta.hpp"
#include "tests/model/sensitivity.hpp"
#include "tests/model/two_chamber_rig.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

constexpr double kGiven_k = 313.15;
constexpr double kViscosity = 0.03;
constexpr double kExpansion = 7e-4;
constexpr double kModulus = 5.5e-3;

/// The rig with oil that follows its temperature.
Experiment warm(Experiment e) {
  e.set("reference_temperature", kGiven_k).set("viscosity_decay", kViscosity);
  e.set("thermal_expansion", kExpansion).set("bulk_modulus_decay", kModulus);
  e.options.tolerance = 1e-10;
  return e;
}

/// A rig of each plant, with every laminar path that it may have.
std::vector<Experiment> leaking_rigs() {
  Experiment plain;
  plain.rig.controller = ControllerKind::none;
  plain.inputs.drive = Signal::sine(3.0, 4.0);
  plain.set("laminar_leakage", 5e-12).set("valve_null_leakage", 3e-12);
  plain.set("leakage_resistance", 2e11);
  Experiment chambers = single_rod_rig();
  chambers.set("laminar_leakage", 3e-13).set("valve_null_leakage", 2e-13);
  chambers.set("external_leakage_a", 2e-13).set("external_leakage_b", 3e-13);
  chambers.set("leakage_coefficient", 0.02).set("leakage_resistance", 5e11);
  chambers.set("return_line_resistance", 2e10).set("air_fraction", 0.01);
  chambers.outputs = {Output::position, Output::pressure_a, Output::leakage_flow};
  Experiment arm = arm_rig();
  arm.set("laminar_leakage", 1e-12).set("return_line_resistance", 2e9);
  arm.set("external_leakage_a", 1e-12).set("external_leakage_b", 1e-12);
  arm.times_s = grid(0.0, 0.5, 26);
  arm.outputs = {Output::angle, Output::pressure_a, Output::leakage_flow};
  return {plain, chambers, arm};
}

}  // namespace

TEST_CASE("warm_oil: a warmer rig is one with thinner, lighter and softer oil", "[model]") {
  for (const Experiment& rig : leaking_rigs()) {
    for (const double above_k : {-20.0, 0.0, 35.0}) {
      Experiment e = warm(rig);
      e.set("oil_temperature", kGiven_k + above_k);
      const Simulation run = e();
      INFO(run.reason);
      REQUIRE(run.ok());
      Experiment by_hand = rig;
      by_hand.options.tolerance = 1e-10;
      const double viscosity = std::exp(-kViscosity * above_k);
      const auto scale = [&](const char* key, double factor) {
        if (rig.values.is_given(key)) by_hand.set(key, rig.values[key] * factor);
      };
      scale("density", 1.0 / (1.0 + kExpansion * above_k));
      scale("bulk_modulus", std::exp(-kModulus * above_k));
      for (const char* key : {"damping", "leakage_resistance", "return_line_resistance"})
        scale(key, viscosity);
      for (const char* key :
           {"laminar_leakage", "valve_null_leakage", "external_leakage_a", "external_leakage_b"})
        scale(key, 1.0 / viscosity);
      const Simulation other = by_hand();
      REQUIRE(other.ok());
      CAPTURE(to_string(rig.rig.plant), above_k);
      CHECK(difference(run.outputs, other.outputs) < 1e-9);
      if (above_k != 0.0) CHECK(difference(run.outputs, rig().outputs) > 1e-3);
      // A recorded temperature that does not change is that parameter.
      e.set("oil_temperature", kGiven_k + 1.0);
      e.inputs.oil_temperature_k = Signal::constant(kGiven_k + above_k);
      const Simulation recorded = e();
      REQUIRE(recorded.ok());
      CHECK(difference(run.outputs, recorded.outputs) < 1e-9);
    }
  }
}

TEST_CASE("warm_oil: with a recorded temperature a rig follows an integrator of another kind",
          "[model]") {
  Experiment e;
  e.rig.controller = ControllerKind::none;
  e = warm(e);
  // Much faster than oil warms, so that the change within a step counts.
  e.inputs.oil_temperature_k =
      Signal::linear({0.0, 0.2, 0.4, 0.6}, {293.15, 333.15, 303.15, 343.15});
  const auto temperature_k = [](double t) {
    if (t < 0.2) return 293.15 + 200.0 * t;
    if (t < 0.4) return 333.15 - 150.0 * (t - 0.2);
    return 303.15 + 200.0 * (t - 0.4);
  };
  e.inputs.drive = Signal::sine(5.0, 4.0);
  e.set("stiffness", 1e5).set("damping", 3000.0).set("laminar_leakage", 2e-11);
  e.times_s = grid(0.0, 0.6, 13);
  e.outputs = {Output::position, Output::velocity, Output::load_pressure, Output::leakage_flow};
  const Simulation run = e();
  REQUIRE(run.ok());
  using Point = std::array<double, 3>;
  const auto density = [&](double t) {
    return 847.0 / (1.0 + kExpansion * (temperature_k(t) - kGiven_k));
  };
  const auto viscosity = [&](double t) {
    return std::exp(-kViscosity * (temperature_k(t) - kGiven_k));
  };
  const auto leak = [&](double pressure, double t) {
    return 0.35 * 4.456e-6 * std::sqrt(2.0 / density(t)) * rounded_root(pressure) +
           2e-11 / viscosity(t) * pressure;
  };
  const Eigen::MatrixXd states =
      runge_kutta(Point{}, e.times_s, 10000, [&](const Point& x, double t) {
        const double spool = 0.0406e-3 * 5.0 * std::sin(8.0 * kPi * t);
        const double head = 6.2e6 - std::copysign(x[2], spool * x[2]);
        const double flow = 0.6 * 0.02075 * spool * rounded_root(head) / std::sqrt(density(t));
        const double modulus = 689e6 * std::exp(-kModulus * (temperature_k(t) - kGiven_k));
        return Point{x[1], (1.62e-3 * x[2] - 3000.0 * viscosity(t) * x[1] - 1e5 * x[0]) / 85.0,
                     4.0 * modulus / 2.46888e-4 * (flow - leak(x[2], t) - 1.62e-3 * x[1])};
      });
  Eigen::MatrixXd other(13, 4);
  other.leftCols(3) = states;
  for (Eigen::Index i = 0; i < 13; ++i)
    other(i, 3) = leak(states(i, 2), e.times_s[static_cast<std::size_t>(i)]);
  CHECK(difference(run.outputs, other) < 2e-5);
  e.options.method = Method::dopri5;
  const Simulation explicit_run = e();
  REQUIRE(explicit_run.ok());
  CHECK(difference(explicit_run.outputs, other) < 2e-5);
  // The implicit method keeps its order: it has the time derivative of the temperature.
  e.options.method = Method::rosenbrock;
  e.options.tolerance = 1e-6;
  const Simulation loose = e();
  REQUIRE(loose.ok());
  CHECK(difference(loose.outputs, other) < 1e-3);
}

TEST_CASE("warm_oil: sensitivities are exact against differences, recorded or not", "[model]") {
  const NamedValues values{{"reference_temperature", kGiven_k},
                           {"viscosity_decay", kViscosity},
                           {"thermal_expansion", kExpansion},
                           {"bulk_modulus_decay", kModulus},
                           {"laminar_leakage", 2e-11}};
  for (const bool recorded : {true, false}) {
    std::set<int> seen;
    Experiment rig;
    if (recorded) {
      rig.inputs.oil_temperature_k = Signal::linear({0.0, 0.05, 0.1}, {333.15, 343.15, 328.15});
    } else {
      rig.set("oil_temperature", 338.15);
    }
    check_sensitivities(
        experiment({"warm", Signal::sine(3.0, 9.0), values, ControllerKind::none}, rig), seen);
    const auto is_seen = [&](const char* key) {
      return seen.count(parameter_index(PlantKind::load_pressure, key)) == 1;
    };
    for (const char* key : {"viscosity_decay", "thermal_expansion", "bulk_modulus_decay", "density",
                            "bulk_modulus", "damping", "laminar_leakage"})
      CHECK(is_seen(key));
    CHECK(is_seen("oil_temperature") == !recorded);
  }
}

TEST_CASE("warm_oil: a loop on acceleration acts on that of the warm rig", "[model]") {
  Experiment e = warm(Experiment());
  e.rig.feedback = Feedback::acceleration;
  e.set("acceleration_kp", 9e-3).set("valve_time_constant", 3e-3).set("damping", 2e4);
  e.inputs.drive = Signal::sine(5.0, 5.0);
  e.inputs.oil_temperature_k = Signal::linear({0.0, 0.3}, {293.15, 343.15});
  e.times_s = grid(0.0, 0.3, 31);
  e.outputs = {Output::acceleration, Output::command};
  const Simulation run = e();
  REQUIRE(run.ok());
  for (Eigen::Index i = 0; i < 31; ++i) {
    const double reference = 5.0 * std::sin(10.0 * kPi * e.times_s[static_cast<std::size_t>(i)]);
    CHECK_THAT(run.outputs(i, 1), WithinAbs(9e-3 * (reference - run.outputs(i, 0)), 1e-9));
  }
  CHECK(peak(run.outputs.col(1)) > 0.01);
}

TEST_CASE("warm_oil: oil that follows a temperature needs one", "[model]") {
  const Simulation run = warm(Experiment())();
  CHECK(run.status == SimulationStatus::bad_parameters);
  CHECK_THAT(run.reason, Catch::Contains("oil_temperature"));
}
