// Tests friction with pre-sliding, of a piston that slides and of one that turns an arm: against
// closed forms, and against an integrator and a right-hand side in this file (docs/model.md,
// sections 2 and 9).

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "model/plant/layout.hpp"
#include "model/plant/terms.hpp"
#include "tests/model/end_of_run.hpp"
#include "tests/model/own_arm.hpp"
#include "tests/model/runge_kutta.hpp"
#include "tests/model/sensitivity.hpp"
#include "tests/model/two_chamber_rig.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

/// A piston that a recorded load pushes, while a wide laminar path joins its chambers. Only spring
/// and friction resist the load.
Experiment pushed_piston(const Signal& load, std::vector<double> times_s) {
  Experiment e;
  e.rig.controller = ControllerKind::none;
  e.inputs.drive = Signal::constant(0.0);
  e.inputs.external_load = load;
  e.set("leakage_coefficient", 0.0).set("laminar_leakage", 1e-5).set("stiffness", 2e4);
  e.set("damping", 2e3).set("coulomb_friction", 200.0).set("stribeck_friction", 80.0);
  e.set("stribeck_velocity", 0.02).set("bristle_stiffness", 1e6).set("bristle_damping", 500.0);
  e.times_s = std::move(times_s);
  e.outputs = {Output::position, Output::velocity, Output::force};
  e.options.tolerance = 1e-10;
  return e;
}

constexpr double kBreakaway_n = 280.0;  // g at rest

/// Force of the bristles after a travel that began at the force `from_n`: dF/dx = sigma_0 (1 -+ F /
/// g).
double bent(double travel_m, double from_n) {
  const double limit = travel_m < 0.0 ? -kBreakaway_n : kBreakaway_n;
  return limit + (from_n - limit) * std::exp(-1e6 * std::abs(travel_m) / kBreakaway_n);
}

}  // namespace

TEST_CASE("bristles: a slow push bends them before they slide, and they stay bent", "[model]") {
  // Pushes out with 150 N within 50 s, then back to zero, so slowly that v hardly lowers g.
  const Signal load =
      Signal::linear({0.0, 50.0, 51.0, 101.0, 102.0}, {0.0, -150.0, -150.0, 0.0, 0.0});
  const Simulation run = pushed_piston(load, {0.0, 50.9, 102.0})();
  INFO(run.reason);
  REQUIRE(run.ok());
  const double out_m = run.outputs(1, 0);
  CHECK_THAT(2e4 * out_m + bent(out_m, 0.0), WithinRel(150.0, 1e-3));
  CHECK(out_m > 150.0 / (1e6 + 2e4));  // further than a linear spring would give
  const double back_m = run.outputs(2, 0);
  REQUIRE(back_m > 0.05 * out_m);
  CHECK_THAT(2e4 * back_m + bent(back_m - out_m, bent(out_m, 0.0)), WithinAbs(0.0, 0.1));
}

TEST_CASE("bristles: where they slide they are dry friction", "[model]") {
  for (const double v : {-0.05, -2e-3, 2e-3, 0.05}) {
    const double sliding = sliding_friction(v, 200.0, 80.0, 0.02);
    CHECK_THAT(sliding, WithinRel(200.0 + 80.0 * std::exp(-std::pow(v / 0.02, 2)), 1e-14));
    CHECK_THAT(bristle_rate(std::copysign(sliding, v), v, sliding, 1e6), WithinAbs(0.0, 1e-9));
    CHECK_THAT(bristle_rate(0.0, v, sliding, 1e6), WithinRel(1e6 * v, 1e-14));
    CHECK_THAT(bristle_rate(-std::copysign(sliding, v), v, sliding, 1e6),
               WithinRel(2e6 * v, 1e-14));
  }
  Experiment e = pushed_piston(Signal::constant(0.0), {0.0, 8.0});
  e.inputs.external_load.reset();
  e.inputs.drive = Signal::constant(0.5);
  e.set("laminar_leakage", 0.0).set("stiffness", 0.0);
  e.outputs = {Output::velocity, Output::load_pressure, Output::force};
  const Simulation run = e();
  REQUIRE(run.ok());
  const double v = run.outputs(1, 0);
  REQUIRE(v > 0.01);
  const double friction_n = 200.0 + 80.0 * std::exp(-std::pow(v / 0.02, 2));
  CHECK_THAT(1.62e-3 * run.outputs(1, 1), WithinRel(2e3 * v + friction_n, 1e-6));
  CHECK_THAT(run.outputs(1, 2), WithinRel(2e3 * v, 1e-6));  // the load cell is outside the seals
}

TEST_CASE("bristles: stick and slip follow an integrator of another kind", "[model]") {
  Experiment e = pushed_piston(Signal::ripple(0.0, 900.0, 2.0, 0.0), grid(0.0, 1.0, 21));
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  using PistonState = std::array<double, 4>;  // position, velocity, load pressure, bristles
  const double mass = e.values["mass"];
  const double area = e.values["piston_area"];
  const double stiff = 4.0 * e.values["bulk_modulus"] / e.values["total_volume"];
  const auto sliding = [](double v) { return 200.0 + 80.0 * std::exp(-v * v / (0.02 * 0.02)); };
  const auto bristles = [&](const PistonState& x) {
    return 1e6 * (x[1] - std::abs(x[1]) * x[3] / sliding(x[1]));
  };
  const auto friction_n = [&](const PistonState& x) { return x[3] + 500.0 / 1e6 * bristles(x); };
  // The laminar path is so wide that the pressure follows the speed immediately, so it is not
  // integrated.
  const auto pressure = [&](const PistonState& x) { return -area * x[1] / 1e-5; };
  REQUIRE(stiff * 1e-5 > 1e6);  // 1/s
  const auto rates = [&](const PistonState& x, double t) -> PistonState {
    const double load = 900.0 * std::sin(4.0 * kPi * t);
    const double force = area * pressure(x) - 2e3 * x[1] - 2e4 * x[0] - friction_n(x) - load;
    return {x[1], force / mass, 0.0, bristles(x)};
  };
  const Eigen::MatrixXd states = runge_kutta(PistonState{}, e.times_s, 20000, rates);
  Eigen::MatrixXd other(21, 3);
  other.leftCols(2) = states.leftCols(2);
  for (int i = 0; i < 21; ++i) {
    const PistonState x{states(i, 0), states(i, 1), states(i, 2), states(i, 3)};
    other(i, 2) = area * pressure(x) - friction_n(x);
  }
  REQUIRE(peak(other.col(0)) > 0.01);
  CHECK(difference(run.outputs, other) < 1e-4);
  e.options.method = Method::dopri5;
  e.set("laminar_leakage", 1e-9);
  const Simulation explicit_run = e();
  e.options.method = Method::rosenbrock;
  const Simulation implicit_run = e();
  REQUIRE(explicit_run.ok());
  REQUIRE(implicit_run.ok());
  CHECK(difference(implicit_run.outputs, explicit_run.outputs) < 1e-5);
}

TEST_CASE("bristles: sensitivities are exact against differences", "[model]") {
  Experiment e = pushed_piston(Signal::constant(0.0), {0.0});
  std::set<int> seen;
  const NamedValues values{{"leakage_coefficient", 0.3}, {"laminar_leakage", 2e-11},
                           {"stiffness", 2e4},           {"bristle_damping", 500.0},
                           {"bristle_stiffness", 1e6},   {"valve_time_constant", 3e-3}};
  e.inputs.external_load.reset();
  Scenario scenario{"stick and slip", Signal::sine(1.0, 9.0), values, ControllerKind::none};
  check_sensitivities(experiment(scenario, e), seen, {{Output::force, 1e4}});
  for (const char* key : {"bristle_stiffness", "bristle_damping", "coulomb_friction",
                          "stribeck_friction", "stribeck_velocity"})
    CHECK(seen.count(parameter_index(PlantKind::load_pressure, key)) == 1);
}

TEST_CASE("friction: seals rub more where pressure presses them on", "[model]") {
  for (const double direction : {1.0, -1.0}) {
    for (const bool pre_sliding : {false, true}) {
      Experiment e = pushed_piston(Signal::constant(0.0), {0.0, 8.0});
      e.inputs.external_load.reset();
      e.inputs.drive = Signal::constant(0.5 * direction);
      e.set("laminar_leakage", 0.0).set("stiffness", 0.0).set("seal_friction", 3e-4);
      e.set("external_force", 500.0 * direction);
      if (!pre_sliding) {
        const auto index =
            static_cast<std::size_t>(parameter_index(e.rig.plant, "bristle_stiffness"));
        e.values.given[index] = false;
      }
      e.outputs = {Output::velocity, Output::load_pressure, Output::force};
      const Simulation run = e();
      REQUIRE(run.ok());
      const double v = run.outputs(1, 0);
      const double P_L = run.outputs(1, 1);
      REQUIRE(direction * v > 0.01);
      const double friction_n =
          200.0 + 80.0 * std::exp(-std::pow(v / 0.02, 2)) + 3e-4 * std::abs(P_L);
      CHECK_THAT(1.62e-3 * P_L, WithinRel(2e3 * v + direction * (500.0 + friction_n), 1e-5));
      CHECK_THAT(run.outputs(1, 2), WithinRel(2e3 * v + direction * 500.0, 1e-5));
    }
  }
}

TEST_CASE("bristles: a loop that had settled holds with them", "[model]") {
  Experiment e;
  e.set("kp", 300.0).set("coulomb_friction", 150.0).set("bristle_stiffness", 2e6);
  e.set("derivative_filter", 300.0).set("velocity_feedforward", 5.0);
  e.set("acceleration_feedforward", 0.1).set("stiffness", 0.0);
  e.inputs.drive = Signal::constant(0.013);
  e.rig.before = Before::steady;
  e.times_s = grid(0.0, 0.2, 21);
  e.outputs = {Output::position, Output::velocity, Output::command};
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  CHECK(peak(run.outputs.col(0).array() - 0.013) < 1e-7);
  CHECK(peak(run.outputs.col(1)) < 1e-7);
  CHECK(peak(run.outputs.col(2)) < 1e-4);
}

TEST_CASE("bristles: a record that begins in motion begins with bent bristles", "[model]") {
  Experiment e = single_rod_rig();
  e.rig.initial = InitialState::given;
  e.set("coulomb_friction", 60.0).set("bristle_stiffness", 1e6).set("bristle_damping", 100.0);
  for (const double v : {0.05, -0.05}) {
    e.set("initial_velocity", v);
    e.times_s = {0.0};
    REQUIRE(layout_of(e.rig, e.values, {}, 4).bristles == 4);
    e.unset("seal_friction");
    CHECK_THAT(end_of_run(e).state[4], WithinRel(std::copysign(60.0, v), 1e-12));
    // Seals are pressed on from the start.
    e.set("seal_friction", 2e-5).set("initial_pressure_a", 5e6).set("initial_pressure_b", 3e6);
    CHECK_THAT(end_of_run(e).state[4], WithinRel(std::copysign(100.0, v), 1e-12));
  }
}

TEST_CASE("film: in steady motion it grows with the velocity to the power of two thirds",
          "[model]") {
  for (const double v : {0.01, -0.04, 0.1})
    CHECK_THAT(steady_film(v, 0.2, 1e-4), WithinRel(std::pow(std::abs(v) / 0.2, 2.0 / 3.0), 1e-4));
  CHECK(steady_film(0.5, 0.2, 1e-3) == 1.0);
  CHECK(steady_film(0.0, 0.2, 1e-3) == 0.0);
  CHECK_THAT(steady_film(1e-3, 0.2, 1e-3), WithinRel(std::pow(0.5 * 1e-3 / 0.2, 2.0 / 3.0), 0.4));
  // In motion at one time constant, at rest at the other.
  CHECK_THAT(film_rate(0.3, 0.7, 0.1, 0.05, 20.0, 1e-3), WithinRel(0.4 / 0.05, 1e-12));
  CHECK_THAT(film_rate(0.3, 0.0, 0.0, 0.05, 20.0, 1e-3), WithinRel(-0.3 / 20.0, 1e-12));
}

namespace {

/// pushed_piston() with a film that grows within 20 ms, decays within 60 ms and dwells for 0.5 s.
Experiment lubricated_piston(const Signal& load, std::vector<double> times_s) {
  Experiment e = pushed_piston(load, std::move(times_s));
  e.set("stribeck_velocity", 0.05).set("stribeck_friction", 250.0);
  e.set("friction_smoothing", 2e-3).set("film_velocity", 0.08).set("film_growth_time", 0.02);
  return e.set("film_decay_time", 0.06).set("film_dwell_time", 0.5);
}

}  // namespace

TEST_CASE("film: stick and slip on a film follow an integrator of another kind", "[model]") {
  Experiment e = lubricated_piston(Signal::ripple(0.0, 900.0, 2.0, 0.0), grid(0.0, 1.0, 21));
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  using PistonState = std::array<double, 4>;  // position, velocity, bristles, film
  const double mass = e.values["mass"];
  const double area = e.values["piston_area"];
  const auto bristles = [](const PistonState& x) {
    const double v = x[1];
    const double sliding = 200.0 + 250.0 * (1.0 - x[3]) * std::exp(-v * v / (0.05 * 0.05));
    return 1e6 * (v - std::abs(v) * x[2] / sliding);
  };
  const auto film = [](const PistonState& x) {
    const double v = x[1];
    const double root = v * v / std::pow(v * v + 4e-6, 2.0 / 3.0);
    const double steady = std::min(root / std::pow(0.08, 2.0 / 3.0), 1.0);
    const double still = std::exp(-v * v / 4e-6);
    return (steady - x[3]) * (still / 0.5 + (1.0 - still) / (x[3] < steady ? 0.02 : 0.06));
  };
  // As above, the pressure follows the speed immediately.
  const auto rates = [&](const PistonState& x, double t) -> PistonState {
    const double friction_n = x[2] + 500.0 / 1e6 * bristles(x);
    const double force = -area * area * x[1] / 1e-5 - 2e3 * x[1] - 2e4 * x[0] - friction_n -
                         900.0 * std::sin(4.0 * kPi * t);
    return {x[1], force / mass, bristles(x), film(x)};
  };
  const Eigen::MatrixXd other = runge_kutta(PistonState{}, e.times_s, 20000, rates);
  REQUIRE(peak(other.col(0)) > 0.01);
  REQUIRE(peak(other.col(3)) > 0.8);
  CHECK(difference(run.outputs.leftCols(2), other.leftCols(2)) < 1e-4);
  // Without the film the piston moves differently.
  for (const char* key :
       {"film_velocity", "film_growth_time", "film_decay_time", "film_dwell_time"})
    e.unset(key);
  CHECK(difference(run.outputs, e().outputs) > 0.02);
}

TEST_CASE("film: where it follows at once, friction falls to Coulomb's at its velocity",
          "[model]") {
  Experiment e = lubricated_piston(Signal::constant(0.0), {0.0, 8.0});
  e.inputs.external_load.reset();
  e.set("film_growth_time", 1e-4).set("film_decay_time", 1e-4).set("stribeck_velocity", 10.0);
  e.set("laminar_leakage", 0.0).set("stiffness", 0.0);
  e.outputs = {Output::velocity, Output::load_pressure};
  e.set("friction_smoothing", 3e-4);
  for (const double command : {0.6, -0.6, 6.0}) {
    e.inputs.drive = Signal::constant(command);
    const Simulation run = e();
    REQUIRE(run.ok());
    const double v = run.outputs(1, 0);
    const double film = std::min(std::pow(std::abs(v) / 0.08, 2.0 / 3.0), 1.0);
    REQUIRE(std::abs(v) > 0.01);
    const double friction_n = 200.0 + 250.0 * (1.0 - film);
    CAPTURE(v);
    CHECK_THAT(1.62e-3 * run.outputs(1, 1),
               WithinRel(2e3 * v + std::copysign(friction_n, v), 3e-3));
  }
}

TEST_CASE("film: a record that begins in motion begins with its film", "[model]") {
  Experiment e = lubricated_piston(Signal::constant(0.0), {0.0});
  e.rig.initial = InitialState::given;
  e.set("initial_velocity", -0.03);
  e.outputs = {Output::load_pressure, Output::force};
  const Simulation run = e();
  REQUIRE(run.ok());
  const double film = std::pow(0.03 / 0.08, 2.0 / 3.0);
  const double sliding = 200.0 + 250.0 * (1.0 - film) * std::exp(-0.36);
  CHECK_THAT(1.62e-3 * run.outputs(0, 0) - run.outputs(0, 1), WithinRel(-sliding, 5e-3));
}

TEST_CASE("film: sensitivities are exact against differences", "[model]") {
  Experiment e = lubricated_piston(Signal::constant(0.0), {0.0});
  e.inputs.external_load.reset();
  std::set<int> seen;
  const NamedValues values{{"laminar_leakage", 2e-11},  {"stiffness", 2e4},
                           {"coulomb_friction", 100.0}, {"stribeck_friction", 400.0},
                           {"stribeck_velocity", 0.1},  {"bristle_stiffness", 2e6},
                           {"bristle_damping", 2e3},    {"friction_smoothing", 0.012},
                           {"film_velocity", 0.04},     {"film_growth_time", 0.01},
                           {"film_decay_time", 0.02},   {"film_dwell_time", 0.02}};
  Scenario scenario{"film", Signal::sine(1.0, 9.0), values, ControllerKind::none};
  check_sensitivities(experiment(scenario, e), seen, {{Output::force, 1e4}});
  for (const char* key :
       {"film_velocity", "film_growth_time", "film_decay_time", "film_dwell_time"}) {
    CAPTURE(key);
    CHECK(seen.count(parameter_index(PlantKind::load_pressure, key)) == 1);
  }
}

TEST_CASE("film: both halves of a period are simulated, since a film has no direction", "[model]") {
  Experiment e;
  e.rig.controller = ControllerKind::pid;
  e.set("kp", 900.0).set("coulomb_friction", 150.0).set("stribeck_friction", 300.0);
  e.set("stribeck_velocity", 0.05).set("bristle_stiffness", 2e6).set("film_velocity", 0.1);
  e.set("film_growth_time", 0.02).set("film_decay_time", 0.05).set("film_dwell_time", 1.0);
  e.inputs.drive = Signal::sine(0.01, 5.0);
  e.times_s = grid(0.0, 12.0, 2401);
  const Simulation early = e();
  e.options.periodic_steady_state = false;
  const Simulation whole = e();
  REQUIRE(early.ok());
  REQUIRE(whole.ok());
  CHECK(early.steps < whole.steps / 3);
  CHECK(difference(whole.outputs, early.outputs) < 1e-4);
}

namespace {

/// own_arm() without a controller, whose cylinder has seals that rub by the pressure.
Experiment rubbing_arm() {
  Experiment e = own_arm(Feedback::angle);
  e.rig.controller = ControllerKind::none;
  e.set("coulomb_friction", 800.0).set("stribeck_friction", 600.0).set("stribeck_velocity", 0.05);
  e.set("friction_smoothing", 2e-3).set("seal_friction", 1e-4);
  return e;
}

/// Magnitude of the friction of rubbing_arm() while its piston slides [N].
double rubbing(double v, double across_pa, double film) {
  return 800.0 + 600.0 * (1.0 - film) * std::exp(-v * v / (0.05 * 0.05)) +
         1e-4 * std::abs(across_pa);
}

}  // namespace

TEST_CASE("linkage: the friction of its cylinder follows an integrator of another kind",
          "[model]") {
  Experiment e = rubbing_arm();
  e.set("bristle_stiffness", 1e7).set("bristle_damping", 1e4);
  e.set("film_velocity", 0.08).set("film_growth_time", 0.02).set("film_decay_time", 0.06);
  e.set("film_dwell_time", 0.5);
  e.inputs.drive = Signal::sine(2.0, 0.7);
  e.times_s = grid(0.0, 2.0, 21);
  e.outputs = {Output::angle,      Output::angular_velocity,
               Output::pressure_a, Output::pressure_b,
               Output::force,      Output::torque};
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  // Angle, angular velocity, both pressures, spool signal, bristles and film.
  using ArmState = std::array<double, 7>;
  const auto bristles = [](const ArmState& x) {
    const double v = own_lever(x[0]) * x[1];
    return 1e7 * (v - std::abs(v) * x[5] / rubbing(v, x[2] - x[3], x[6]));
  };
  const auto friction_n = [&](const ArmState& x) { return x[5] + 1e4 / 1e7 * bristles(x); };
  const auto film = [](const ArmState& x) {
    const double v = own_lever(x[0]) * x[1];
    const double root = v * v / std::pow(v * v + 4e-6, 2.0 / 3.0);
    const double steady = std::min(root / std::pow(0.08, 2.0 / 3.0), 1.0);
    const double still = std::exp(-v * v / 4e-6);
    return (steady - x[6]) * (still / 0.5 + (1.0 - still) / (x[6] < steady ? 0.02 : 0.06));
  };
  const auto rates = [&](const ArmState& x, double t) -> ArmState {
    const auto arm =
        own_arm_rates(x, own_lever(x[0]) * friction_n(x), 2.0 * std::sin(2.0 * kPi * 0.7 * t));
    return {arm[0], arm[1], arm[2], arm[3], arm[4], bristles(x), film(x)};
  };
  const Eigen::MatrixXd states =
      runge_kutta(ArmState{0.0, 0.0, run.outputs(0, 2), run.outputs(0, 3)}, e.times_s, 4000, rates);
  Eigen::MatrixXd other(states.rows(), 6);
  other.leftCols(4) = states.leftCols(4);
  for (Eigen::Index i = 0; i < states.rows(); ++i) {
    ArmState x{};
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = states(i, static_cast<Eigen::Index>(k));
    other(i, 4) = 4e-3 * x[2] - 2.4e-3 * x[3] - friction_n(x);
    other(i, 5) = own_lever(x[0]) * other(i, 4);
  }
  REQUIRE(peak(other.col(0)) > 0.1);
  REQUIRE(peak(other.col(0)) < 0.99);
  REQUIRE(peak(states.col(6)) > 0.8);
  CHECK(difference(run.outputs, other) < 1e-4);
  e.options.method = Method::dopri5;
  const Simulation explicit_run = e();
  REQUIRE(explicit_run.ok());
  CHECK(difference(run.outputs, explicit_run.outputs) < 1e-5);
}

TEST_CASE("linkage: a slow moment bends the bristles of the cylinder by its lever", "[model]") {
  // Equal areas, joined by a wide laminar path: only friction and a moment that grows with the
  // angle resist. The arm is where the lever is 0.4 m/rad, and damped, since bristles creep under
  // an arm that swings.
  Experiment e = arm_rig();
  e.set("joint_damping", 2e4);
  e.rig.initial = InitialState::given;
  e.set("area_b", 4e-3).set("laminar_leakage", 1e-5).set("lever_gradient", 0.2);
  e.set("initial_angle", 0.5).set("gravity_moment", -1e3).set("gravity_moment_gradient", 2e3);
  e.set("coulomb_friction", 200.0).set("stribeck_friction", 80.0).set("stribeck_velocity", 0.02);
  e.set("bristle_stiffness", 1e6).set("bristle_damping", 500.0);
  e.inputs.drive = Signal::constant(0.0);
  e.inputs.external_load =
      Signal::linear({0.0, 50.0, 51.0, 101.0, 102.0}, {0.0, -60.0, -60.0, 0.0, 0.0});
  e.times_s = {0.0, 50.9, 102.0};
  e.outputs = {Output::angle, Output::position, Output::force, Output::torque};
  e.options.tolerance = 1e-10;
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  const auto lever = [&](Eigen::Index i) { return 0.3 + 0.2 * run.outputs(i, 0); };
  const auto spring = [&](Eigen::Index i) { return 2e3 * (run.outputs(i, 0) - 0.5); };
  const double out_m = run.outputs(1, 1) - run.outputs(0, 1);
  const double out_n = bent(out_m, 0.0);
  CHECK_THAT(lever(1) * out_n + spring(1), WithinRel(60.0, 1e-3));
  CHECK(out_m > 1.1 * lever(1) * (60.0 / (0.16e6 + 2e3)));  // further than a linear spring gives
  const double back_m = run.outputs(2, 1) - run.outputs(1, 1);
  REQUIRE(run.outputs(2, 0) - 0.5 > 0.05 * (run.outputs(1, 0) - 0.5));
  CHECK_THAT(lever(2) * bent(back_m, out_n) + spring(2), WithinAbs(0.0, 0.04));
  // Rod and joint feel what the oil exerts less the friction.
  CHECK_THAT(run.outputs(1, 3), WithinRel(lever(1) * run.outputs(1, 2), 1e-9));
  CHECK_THAT(run.outputs(1, 2), WithinRel(-out_n, 1e-2));
}

TEST_CASE("linkage: seals rub more where pressure presses them on", "[model]") {
  for (const double direction : {1.0, -1.0}) {
    for (const bool pre_sliding : {false, true}) {
      CAPTURE(direction, pre_sliding);
      Experiment e = rubbing_arm();
      e.set("lever_gradient", 0.0)
          .set("gravity_moment", 2e3 * direction)
          .set("joint_friction", 50.0);
      if (pre_sliding) e.set("bristle_stiffness", 1e7).set("bristle_damping", 1e4);
      e.inputs.drive = Signal::constant(0.3 * direction);
      e.times_s = {0.0, 3.0};
      e.outputs = {Output::angular_velocity, Output::pressure_a, Output::pressure_b, Output::force,
                   Output::torque};
      const Simulation run = e();
      INFO(run.reason);
      REQUIRE(run.ok());
      const double omega = run.outputs(1, 0);
      REQUIRE(direction * omega > 0.02);
      const double across_pa = run.outputs(1, 1) - run.outputs(1, 2);
      const double friction_n = direction * rubbing(0.3 * omega, across_pa, 0.0);
      const double load = 1e4 * omega + 2e3 * direction;
      CHECK_THAT(own_moment(0.0, run.outputs(1, 1), run.outputs(1, 2)),
                 WithinRel(load + 50.0 * direction + 0.3 * friction_n, 1e-4));
      CHECK_THAT(run.outputs(1, 4), WithinRel(load, 1e-4));
      CHECK_THAT(0.3 * run.outputs(1, 3), WithinRel(load + 50.0 * direction, 1e-4));
    }
  }
}

TEST_CASE("linkage: a record that begins in motion begins with the friction of its piston",
          "[model]") {
  Experiment e = rubbing_arm();
  e.rig.initial = InitialState::given;
  e.set("bristle_stiffness", 1e7).set("film_velocity", 0.2).set("film_growth_time", 0.02);
  e.set("film_decay_time", 0.06).set("film_dwell_time", 0.5);
  e.set("initial_angular_velocity", -0.2).set("initial_angle", 0.5);
  e.set("initial_pressure_a", 5e6).set("initial_pressure_b", 3e6);
  e.inputs.drive = Signal::constant(0.0);
  e.times_s = {0.0};
  e.outputs = {Output::force, Output::velocity};
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  const double v = -0.2 * own_lever(0.5);
  CHECK_THAT(run.outputs(0, 1), WithinRel(v, 1e-12));
  const double film = std::pow(std::abs(v) / 0.2, 2.0 / 3.0);
  CHECK_THAT(run.outputs(0, 0), WithinRel(4e-3 * 5e6 - 2.4e-3 * 3e6 + rubbing(v, 2e6, film), 1e-3));
}
