// Tests the travel of a piston over the angle of a joint by a triangle and by a table: closed
// forms, limits, and the motion of an arm against an integrator of another kind (docs/model.md,
// section 9).

#include "model/plant/piston_travel.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/model/linkage_rig.hpp"
#include "tests/model/runge_kutta.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

Experiment on_triangle(double base_m, double arm_m, double angle_rad) {
  Experiment e = arm_rig();
  e.unset("lever").set("triangle_base", base_m).set("triangle_arm", arm_m);
  return e.set("triangle_angle", angle_rad);
}

Experiment with_travel(double from_rad, double to_rad, const std::array<double, 6>& travel_m) {
  Experiment e = arm_rig();
  e.unset("lever").set("travel_table_from", from_rad).set("travel_table_to", to_rad);
  constexpr std::array kKeys{"travel_0",  "travel_20", "travel_40",
                             "travel_60", "travel_80", "travel_100"};
  for (std::size_t i = 0; i < kKeys.size(); ++i) e.set(kKeys[i], travel_m[i]);
  return e;
}

/// Checks lever and slope against differences of the travel.
void check_derivatives(const Experiment& e, double angle_rad) {
  constexpr double kDifference = 1e-4;
  CAPTURE(angle_rad);
  const auto at = piston_travel(e.values, angle_rad);
  const auto above = piston_travel(e.values, angle_rad + kDifference);
  const auto below = piston_travel(e.values, angle_rad - kDifference);
  CHECK_THAT(at.lever_m_per_rad,
             WithinAbs((above.travel_m - below.travel_m) / (2.0 * kDifference), 1e-7));
  CHECK_THAT(
      at.slope_m_per_rad2,
      WithinAbs((above.lever_m_per_rad - below.lever_m_per_rad) / (2.0 * kDifference), 1e-6));
}

/// Motion of arm_rig(), which may have other areas, with the pilot pressure 2.8 MPa sin(2 pi 0.5
/// t), by an integrator of another kind. Columns: angle, angular velocity, both pressures.
///
/// @param travel  from an angle to travel and lever
template <typename Travel>
Eigen::MatrixXd integrated(const Experiment& e, double a_pa, double b_pa, const Travel& travel,
                           const std::array<double, 2>& area) {
  const double retracted = travel(-1.0)[0];
  const double extended = travel(1.0)[0];
  return runge_kutta(
      std::array<double, 4>{0.0, 0.0, a_pa, b_pa}, e.times_s, 4000,
      [&](const std::array<double, 4>& x, double t) {
        const double out = 2.8e6 * std::sin(kPi * t);
        const auto edge = [](double signal_pa, double head_pa) {
          const double opening_m = 5e-10 * std::max(signal_pa - 1e6, 0.0);
          return 0.65 * 0.02 * std::sqrt(2.0 / 870.0) * opening_m * rounded_root(head_pa);
        };
        const auto [s, lever] = travel(x[0]);
        const double flow_a = edge(out, 2e7 - x[2]) - edge(-out, x[2] - 2e5);
        const double flow_b = edge(-out, 2e7 - x[3]) - edge(out, x[3] - 2e5);
        const double moment =
            lever * (area[0] * x[2] - area[1] * x[3]) - 1e4 * x[1] - 4e3 - 1500.0 * x[0];
        return std::array<double, 4>{
            x[1], moment / 400.0,
            8e8 / (1e-3 + area[0] * (s - retracted)) * (flow_a - area[0] * lever * x[1]),
            8e8 / (1e-3 + area[1] * (extended - s)) * (flow_b + area[1] * lever * x[1])};
      });
}

/// Compares an arm that swings within its stops with integrated().
template <typename Travel>
void check_motion(Experiment e, const Travel& travel,
                  const std::array<double, 2>& area = {4e-3, 2.4e-3}) {
  e.set("joint_damping", 1e4).set("gravity_moment", 4e3).set("gravity_moment_gradient", 1500.0);
  e.inputs.drive = Signal::sine(2.8e6, 0.5);
  e.times_s = grid(0.0, 1.6, 17);
  e.outputs = {Output::angle,      Output::angular_velocity, Output::pressure_a,
               Output::pressure_b, Output::position,         Output::torque};
  e.options.tolerance = 1e-9;
  for (const Method method : {Method::rosenbrock, Method::dopri5}) {
    e.options.method = method;
    const Simulation run = e();
    INFO(run.reason);
    REQUIRE(run.ok());
    const Eigen::MatrixXd other = integrated(e, run.outputs(0, 2), run.outputs(0, 3), travel, area);
    REQUIRE(peak(other.col(0)) > 0.5);
    REQUIRE(peak(other.col(0)) < 0.99);
    CHECK(difference(run.outputs.leftCols(4), other) < 3e-5);
    Eigen::VectorXd torque(other.rows());
    for (Eigen::Index i = 0; i < other.rows(); ++i) {
      CHECK_THAT(run.outputs(i, 4), WithinAbs(travel(run.outputs(i, 0))[0], 1e-12));
      torque(i) = travel(other(i, 0))[1] * (area[0] * other(i, 2) - area[1] * other(i, 3));
    }
    CHECK(difference(run.outputs.col(5), torque) < 1e-4);
  }
}

}  // namespace

TEST_CASE("piston_travel: of a right-angled triangle it is Pythagoras'", "[model]") {
  const Experiment e = on_triangle(3.0, 4.0, 0.5 * kPi);  // 3, 4, 5
  const auto at_reference = piston_travel(e.values, 0.0);
  CHECK_THAT(at_reference.travel_m, WithinAbs(0.0, 1e-15));
  CHECK_THAT(at_reference.lever_m_per_rad, WithinRel(12.0 / 5.0, 1e-14));
  CHECK_THAT(at_reference.slope_m_per_rad2, WithinRel(-2.4 * 2.4 / 5.0, 1e-14));
  // With the pivots in line the cylinder has no lever.
  CHECK_THAT(piston_travel(e.values, 0.5 * kPi).travel_m, WithinAbs(7.0 - 5.0, 1e-14));
  CHECK_THAT(piston_travel(e.values, 0.5 * kPi).lever_m_per_rad, WithinAbs(0.0, 1e-14));
  CHECK_THAT(piston_travel(e.values, -0.5 * kPi).travel_m, WithinAbs(1.0 - 5.0, 1e-14));
  for (const double angle : {-1.2, -0.4, 0.1, 0.9}) check_derivatives(e, angle);
}

TEST_CASE("piston_travel: the reference angle has the angle of the triangle", "[model]") {
  Experiment e = on_triangle(3.0, 4.0, 0.5 * kPi);
  e.set("reference_angle", -0.7);
  CHECK_THAT(piston_travel(e.values, -0.7).lever_m_per_rad, WithinRel(2.4, 1e-14));
  CHECK_THAT(piston_travel(e.values, -0.7).travel_m, WithinAbs(0.0, 1e-14));
}

TEST_CASE("piston_travel: a cylinder that shortens is a mirrored one that lengthens", "[model]") {
  const Experiment lengthens = on_triangle(1.9, 0.8, 1.4);
  const Experiment shortens = on_triangle(1.9, 0.8, -1.4);
  for (const double angle : {-1.1, -0.3, 0.0, 0.8}) {
    CAPTURE(angle);
    const auto one = piston_travel(lengthens.values, angle);
    const auto other = piston_travel(shortens.values, -angle);
    CHECK_THAT(other.travel_m, WithinAbs(-one.travel_m, 1e-15));
    CHECK_THAT(other.lever_m_per_rad, WithinRel(one.lever_m_per_rad, 1e-14));
    CHECK(one.lever_m_per_rad > 0.1);
    check_derivatives(shortens, -angle);
  }
}

TEST_CASE("piston_travel: a cylinder much longer than the arm pulls at its sine", "[model]") {
  const Experiment e = on_triangle(900.0, 0.5, 1.2);
  for (const double angle : {-1.0, 0.0, 0.7})
    CHECK_THAT(piston_travel(e.values, angle).lever_m_per_rad,
               WithinRel(0.5 * std::sin(1.2 + angle), 1e-3));
}

TEST_CASE("piston_travel: of a table, the lever is a line between the middles of its pieces",
          "[model]") {
  const std::array<double, 6> travel_m{0.0, 0.10, 0.24, 0.40, 0.52, 0.61};
  const Experiment e = with_travel(-1.25, 1.25, travel_m);  // pieces of half a radian
  for (std::size_t piece = 0; piece < 5; ++piece) {
    const double middle = -1.0 + 0.5 * static_cast<double>(piece);
    const auto at = piston_travel(e.values, middle);
    CAPTURE(middle);
    CHECK_THAT(at.travel_m, WithinAbs(0.5 * (travel_m[piece] + travel_m[piece + 1]), 1e-14));
    CHECK_THAT(at.lever_m_per_rad, WithinAbs((travel_m[piece + 1] - travel_m[piece]) / 0.5, 1e-13));
    check_derivatives(e, middle + 0.2);
    if (piece == 4) continue;
    // Halfway to the next middle the lever is the mean of both.
    CHECK_THAT(piston_travel(e.values, middle + 0.25).lever_m_per_rad,
               WithinAbs(travel_m[piece + 2] - travel_m[piece], 1e-13));
  }
  // Beyond its ends, the first and the last piece continue.
  CHECK_THAT(piston_travel(e.values, -2.0).travel_m, WithinAbs(-0.75 * 0.2, 1e-13));
  CHECK_THAT(piston_travel(e.values, 2.0).lever_m_per_rad, WithinAbs(0.18, 1e-13));
}

TEST_CASE("linkage: a table of equal steps is a constant lever", "[model]") {
  Experiment constant = arm_rig();
  constant.outputs = {Output::angle, Output::pressure_a, Output::pressure_b, Output::velocity};
  constant.inputs.drive = Signal::sine(2.5e6, 0.5);
  constant.options.tolerance = 1e-9;
  Experiment table = with_travel(-1.5, 1.0, {0.0, 0.15, 0.3, 0.45, 0.6, 0.75});
  table.outputs = constant.outputs;
  table.inputs.drive = constant.inputs.drive;
  table.options.tolerance = 1e-9;
  const Simulation one = constant();
  const Simulation other = table();
  REQUIRE(one.ok());
  REQUIRE(other.ok());
  REQUIRE(peak(one.outputs.col(0)) > 0.2);
  CHECK(difference(one.outputs, other.outputs) < 1e-6);
}

TEST_CASE("linkage: a polynomial follows the triangle near the reference angle", "[model]") {
  const Experiment triangle = on_triangle(1.2, 0.35, 1.3);
  const auto at = piston_travel(triangle.values, 0.0);
  Experiment polynomial = arm_rig();
  polynomial.set("lever", at.lever_m_per_rad).set("lever_gradient", at.slope_m_per_rad2);
  const auto error = [&](double angle) {
    return std::abs(piston_travel(triangle.values, angle).travel_m -
                    piston_travel(polynomial.values, angle).travel_m);
  };
  REQUIRE(error(0.2) > 1e-5);
  CHECK_THAT(error(0.1) / error(0.2), WithinAbs(1.0 / 8.0, 0.02));  // the first term left out
}

TEST_CASE("linkage: an arm with its lever by a polynomial follows an integrator of another kind",
          "[model]") {
  Experiment e = arm_rig();
  e.set("lever", 0.3).set("lever_gradient", -0.12).set("lever_curvature", -0.09);
  check_motion(e, [](double angle) {
    // The travel is the lever's integral from 0, exactly by Simpson's rule.
    const auto lever = [](double at) { return 0.3 - 0.12 * at - 0.09 * at * at; };
    const double travel = angle / 6.0 * (lever(0.0) + 4.0 * lever(0.5 * angle) + lever(angle));
    return std::array<double, 2>{travel, lever(angle)};
  });
}

TEST_CASE("linkage: an arm on a triangle follows an integrator of another kind", "[model]") {
  // The cylinder as a vector from (1.2, 0) to the pivot on the arm: its length, and its moment by
  // the cross product.
  for (const double side : {1.0, -1.0}) {
    check_motion(on_triangle(1.2, 0.35, side * 1.3), [side](double angle) {
      const double psi = side * 1.3 + angle;
      const double x = 0.35 * std::cos(psi);
      const double y = 0.35 * std::sin(psi);
      const double length = std::hypot(x - 1.2, y);
      const double at_reference = std::hypot(0.35 * std::cos(1.3) - 1.2, 0.35 * std::sin(1.3));
      const double cross = (x * y - y * (x - 1.2)) / length;
      return std::array<double, 2>{side * (length - at_reference), side * cross};
    });
  }
}

TEST_CASE("linkage: an arm with its travel by a table follows an integrator of another kind",
          "[model]") {
  const std::array<double, 6> travel_m{0.0, 0.10, 0.24, 0.40, 0.52, 0.61};
  check_motion(with_travel(-1.2, 1.3, travel_m), [&](double angle) {
    // A quadratic spline with its knots in the middles, as a sum of ramps.
    const double place = 2.0 * (angle + 1.2);
    double travel = travel_m[0] + (travel_m[1] - travel_m[0]) * place;
    double lever = travel_m[1] - travel_m[0];
    for (std::size_t i = 1; i < 5; ++i) {
      const double bend = travel_m[i + 1] - 2.0 * travel_m[i] + travel_m[i - 1];
      const double past = place - static_cast<double>(i);
      const double within = std::clamp(past + 0.5, 0.0, 1.0);
      travel += bend * (std::abs(past) < 0.5 ? 0.5 * within * within : std::max(past, 0.0));
      lever += bend * within;
    }
    return std::array<double, 2>{travel, 2.0 * lever};
  });
}

TEST_CASE("linkage: a rotary actuator follows an integrator of another kind", "[model]") {
  Experiment e = arm_rig().unset("lever").unset("area_a").unset("area_b");
  e.set("displacement_per_radian", 1.1e-3);
  check_motion(e, [](double angle) { return std::array<double, 2>{angle, 1.0}; }, {1.1e-3, 1.1e-3});
}

TEST_CASE("linkage: a rotary actuator turns by its displacement, and holds a moment", "[model]") {
  Experiment e = arm_rig().unset("lever").unset("area_a").unset("area_b");
  e.set("displacement_per_radian", 5e-4);
  e.rig.initial = InitialState::given;
  e.inputs.drive = Signal::constant(0.0);
  e.set("gravity_moment", 2e3).set("initial_angle", 0.3);
  e.times_s = {0.0, 1.0};
  e.options.tolerance = 1e-9;
  e.set("torque_gain", 1.1).set("torque_offset", 50.0);
  e.outputs = {Output::angle, Output::load_pressure, Output::force, Output::torque};
  const Simulation held = e();
  REQUIRE(held.ok());
  CHECK_THAT(held.outputs(1, 0), WithinAbs(0.3, 1e-6));
  CHECK_THAT(held.outputs(1, 1), WithinRel(2e3 / 5e-4, 1e-5));
  CHECK_THAT(held.outputs(1, 2), WithinRel(2e3, 1e-5));  // the moment
  CHECK_THAT(held.outputs(1, 3), WithinRel(1.1 * 2e3 + 50.0, 1e-5));
  e.set("torque_maximum", 2100.0);  // the converter shows no more
  CHECK(e().outputs(1, 3) == 2100.0);
  e.rig.initial = InitialState::rest;
  e.set("lower_stop", -2.0).set("upper_stop", 2.0).set("joint_damping", 2e4);
  e.set("pilot_gain", 1e-11).set("gravity_moment", 0.0);
  e.inputs.drive = Signal::constant(2e6);
  e.times_s = {0.0, 20.0};
  e.outputs = {Output::angular_velocity, Output::pressure_a, Output::pressure_b};
  const Simulation turns = e();
  REQUIRE(turns.ok());
  REQUIRE(turns.outputs(1, 0) > 0.02);
  const double flow = 0.65 * 0.02 * 1e-5 * std::sqrt(2.0 * (2e7 - turns.outputs(1, 1)) / 870.0);
  CHECK_THAT(turns.outputs(1, 0), WithinRel(flow / 5e-4, 1e-4));
  CHECK_THAT(5e-4 * (turns.outputs(1, 1) - turns.outputs(1, 2)),
             WithinRel(2e4 * turns.outputs(1, 0), 1e-4));
}

TEST_CASE("linkage: without a lever, or with half a triangle, it does not move", "[model]") {
  Experiment none = arm_rig().unset("lever");
  const Simulation run = none();
  CHECK(run.status == SimulationStatus::bad_parameters);
  CHECK_THAT(run.reason, Catch::Contains("lever"));
  Experiment half = arm_rig().unset("lever").set("triangle_base", 1.0);
  CHECK_THAT(half().reason, Catch::Contains("triangle_arm"));
  CHECK_THAT(arm_rig().unset("area_b")().reason, Catch::Contains("area_b"));
}
