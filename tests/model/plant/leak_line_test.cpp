// Tests the internal leak as a single law from laminar to turbulent, also against an integrator of
// another kind (docs/model.md, section 2).

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "tests/model/both_methods.hpp"
#include "tests/model/runge_kutta.hpp"
#include "tests/model/sensitivity.hpp"
#include "tests/model/two_chamber_rig.hpp"

using namespace rigcal::model;
using Catch::WithinRel;

namespace {

/// Pressure across the piston and its leakage, for a piston under load with the valve closed.
std::pair<double, double> held_leak(Experiment e, double load_n) {
  e.rig.controller = ControllerKind::none;
  e.inputs.drive = Signal::constant(0.0);
  e.set("external_force", load_n).set("leakage_coefficient", 0.5);
  e.set("leakage_resistance", 2e11);
  e.rig.initial = InitialState::given;  // pressures that balance the load
  e.times_s = {0.0};
  e.outputs = {Output::load_pressure, Output::leakage_flow};
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  return {run.outputs(0, 0), run.outputs(0, 1)};
}

/// Leak at which the losses of orifice and laminar path add up to a pressure, (Q / G)^2 + R Q = P,
/// by Newton's method from above.
double own_leak(double head_pa, double conductance, double resistance) {
  const double size_pa = std::abs(head_pa);
  double flow = size_pa / resistance;
  for (int i = 0; i < 20; ++i) {
    const double excess_pa =
        flow * flow / (conductance * conductance) + resistance * flow - size_pa;
    flow -= excess_pa / (2.0 * flow / (conductance * conductance) + resistance);
  }
  return std::copysign(flow, head_pa);
}

}  // namespace

TEST_CASE("leak: orifice and laminar path in series are one law", "[model]") {
  for (const Experiment& rig : {Experiment(), single_rod_rig()}) {
    const double area = rig.values["leakage_area"];
    const double density = rig.values["density"];
    for (const double load_n : {-400.0, 3.0, 60.0, 400.0}) {
      const auto [head_pa, flow] = held_leak(rig, load_n);
      // The line takes the pressure R Q, the orifice the rest.
      const double conductance = 0.5 * area * std::sqrt(2.0 / density);
      const double rest_pa = std::abs(head_pa) - 2e11 * std::abs(flow);
      REQUIRE(rest_pa > 0.0);
      CHECK_THAT(std::abs(flow), WithinRel(conductance * std::sqrt(rest_pa), 1e-3));
      CHECK(flow * head_pa > 0.0);
    }
  }
}

TEST_CASE("leak: rigs with the one law follow an integrator of another kind", "[model]") {
  SECTION("load pressure") {
    Experiment e;
    e.rig.controller = ControllerKind::none;
    e.inputs.drive = Signal::sine(5.0, 4.0);
    e.set("stiffness", 1e5).set("damping", 3000.0).set("leakage_resistance", 2e10);
    e.times_s = grid(0.0, 0.6, 13);
    e.outputs = {Output::position, Output::velocity, Output::load_pressure, Output::leakage_flow};
    const auto leak = [](double pressure_pa) {
      return own_leak(pressure_pa, 0.35 * 4.456e-6 * std::sqrt(2.0 / 847.0), 2e10);
    };
    using Point = std::array<double, 3>;
    const Eigen::MatrixXd states =
        runge_kutta(Point{}, e.times_s, 4000, [&](const Point& x, double t) {
          const double spool = 0.0406e-3 * 5.0 * std::sin(8.0 * kPi * t);
          const double head = 6.2e6 - std::copysign(x[2], spool * x[2]);
          const double flow = 0.6 * 0.02075 * spool * rounded_root(head) / std::sqrt(847.0);
          return Point{x[1], (1.62e-3 * x[2] - 3000.0 * x[1] - 1e5 * x[0]) / 85.0,
                       4.0 * 689e6 / 2.46888e-4 * (flow - leak(x[2]) - 1.62e-3 * x[1])};
        });
    Eigen::MatrixXd other(13, 4);
    other.leftCols(3) = states;
    for (Eigen::Index i = 0; i < 13; ++i) other(i, 3) = leak(states(i, 2));
    check_both_methods(e, other);
  }
  SECTION("two chambers") {
    Experiment e = proportional_rig();
    e.inputs.drive = Signal::sine(6.0, 0.8);
    e.set("leakage_coefficient", 0.5).set("leakage_resistance", 5e10).set("stiffness", 5e4);
    e.times_s = grid(0.0, 1.4, 15);
    e.outputs.push_back(Output::leakage_flow);
    const Simulation start = e();
    REQUIRE(start.ok());
    const auto leak = [](double head_pa) {
      return own_leak(head_pa, 0.5 * 1e-6 * std::sqrt(2.0 / 870.0), 5e10);
    };
    using Point = std::array<double, 4>;
    const auto rates = [&](const Point& x, double t) {
      const double out = 6.0 * std::sin(2.0 * kPi * 0.8 * t);
      const auto edge = [](double signal, double head_pa) {
        const double opening = 2e-6 * std::max(signal - 0.5, 0.0);
        return 0.65 * 0.02 * std::sqrt(2.0 / 870.0) * opening * rounded_root(head_pa);
      };
      const double across = leak(x[2] - x[3]);
      const double flow_a = edge(out, 2e7 - x[2]) - edge(-out, x[2] - 2e5) - across;
      const double flow_b = edge(-out, 2e7 - x[3]) - edge(out, x[3] - 2e5) + across;
      return Point{x[1], (4e-3 * x[2] - 2.4e-3 * x[3] - 4e4 * x[1] - 5e4 * x[0]) / 2000.0,
                   8e8 / (1e-3 + 4e-3 * (x[0] + 0.5)) * (flow_a - 4e-3 * x[1]),
                   8e8 / (1e-3 + 2.4e-3 * (0.5 - x[0])) * (flow_b + 2.4e-3 * x[1])};
    };
    const Eigen::MatrixXd states = runge_kutta(
        Point{0.0, 0.0, start.outputs(0, 2), start.outputs(0, 3)}, e.times_s, 4000, rates);
    Eigen::MatrixXd other(15, 5);
    other.leftCols(4) = states;
    for (Eigen::Index i = 0; i < 15; ++i) other(i, 4) = leak(states(i, 2) - states(i, 3));
    check_both_methods(e, other);
  }
}

TEST_CASE("leak: sensitivities of the one law are exact against differences", "[model]") {
  const NamedValues values{{"leakage_coefficient", 0.5}, {"leakage_resistance", 2e11}};
  std::set<int> seen;
  const Scenario scenario{"one law", Signal::sine(0.01, 9.0), values};
  check_sensitivities(experiment(scenario), seen);
  CHECK(seen.count(parameter_index(PlantKind::load_pressure, "leakage_resistance")) == 1);
}
