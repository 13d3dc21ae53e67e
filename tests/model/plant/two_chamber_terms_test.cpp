// Tests sign and size of every optional term of the two-chamber plant against steady states, exact
// solutions, and one derivative written by hand (docs/model.md).

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "model/plant/two_chamber.hpp"
#include "tests/model/end_of_run.hpp"
#include "tests/model/two_chamber_rig.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

constexpr double kA_m2 = 2.0e-4;
constexpr double kB_m2 = 1.2e-4;
constexpr double kSupply_pa = 4.4e6;
constexpr double kTank_pa = 1e5;

double head_root(double pressure_pa) {
  return std::copysign(std::sqrt(std::abs(pressure_pa)), pressure_pa);
}

/// Flow through an open edge.
double edge_flow(double opening_v, double head_pa) {
  return 0.6 * 0.02075 * 4e-6 * opening_v * head_root(2.0 * head_pa / 847.0);
}

/// A single-rod cylinder with a stroke long enough to reach a steady speed.
Experiment driven_rod(double command_v) {
  Experiment e = single_rod_rig();
  e.inputs.drive = Signal::constant(command_v);
  e.set("stroke", 2.0).set("retracted_position", -1.0).set("mass", 1.0).set("damping", 400.0);
  e.times_s = {0.0, 8.0};
  e.outputs = {Output::velocity,   Output::pressure_a,   Output::pressure_b, Output::force,
               Output::servo_flow, Output::leakage_flow, Output::work_flow,  Output::spool};
  e.options.tolerance = 1e-9;
  return e;
}

struct SteadyRod {
  double v, p_A, p_B, force_n, servo_flow, leakage_flow, work_flow, spool_m;

  double push_n() const { return kA_m2 * p_A - kB_m2 * p_B; }
};

SteadyRod steady_rod(const Experiment& e) {
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  const auto last = run.outputs.row(run.outputs.rows() - 1);
  return {last(0), last(1), last(2), last(3), last(4), last(5), last(6), last(7)};
}

}  // namespace

TEST_CASE("two_chamber: in steady motion the pressures hold what loads the piston", "[model]") {
  struct Row {
    const char* key;
    double value;
    double load_n;
  };
  for (const double direction : {1.0, -1.0}) {
    for (const Row& row :
         {Row{"gravity", 9.81, 9.81}, Row{"external_force", 60.0, 60.0},
          Row{"external_force", -60.0, -60.0}, Row{"coulomb_friction", 50.0, direction * 50.0}}) {
      Experiment e = driven_rod(2.0 * direction);
      e.set(row.key, row.value);
      const SteadyRod s = steady_rod(e);
      CAPTURE(row.key, direction, s.v);
      CHECK(direction * s.v > 0.03);
      CHECK_THAT(s.push_n(), WithinRel(400.0 * s.v + row.load_n, 1e-5));
      // A load cell in the rod reads everything except the dry friction of the cylinder.
      const double friction_n = std::string(row.key) == "coulomb_friction" ? row.load_n : 0.0;
      CHECK_THAT(s.force_n, WithinRel(s.push_n() - friction_n, 1e-9));
      CHECK_THAT(s.work_flow, WithinRel(0.5 * (kA_m2 + kB_m2) * s.v, 1e-9));
    }
  }
}

TEST_CASE("two_chamber: each edge has its own area and overlap", "[model]") {
  for (const double direction : {1.0, -1.0}) {
    Experiment e = driven_rod(2.0 * direction);
    e.set("gain_supply_to_a", 1.2).set("gain_a_to_tank", 0.8).set("gain_supply_to_b", 1.4);
    e.set("gain_b_to_tank", 0.7).set("valve_dead_band", 0.1).set("valve_offset", 0.05);
    e.set("overlap_supply_to_a", 0.2).set("overlap_a_to_tank", -0.05);
    e.set("overlap_supply_to_b", 0.3).set("overlap_b_to_tank", 0.4);
    const SteadyRod s = steady_rod(e);
    CAPTURE(direction, s.v);
    CHECK_THAT(s.spool_m, WithinRel(4e-6 * (2.0 * direction + 0.05), 1e-12));
    if (direction > 0.0) {
      const double in = 1.2 * edge_flow(2.05 - 0.1 - 0.2, kSupply_pa - s.p_A);
      const double out = 0.7 * edge_flow(2.05 - 0.1 - 0.4, s.p_B - kTank_pa);
      CHECK_THAT(kA_m2 * s.v, WithinRel(in, 1e-5));
      CHECK_THAT(kB_m2 * s.v, WithinRel(out, 1e-5));
      CHECK_THAT(s.servo_flow, WithinRel(0.5 * (in + out), 1e-5));
    } else {
      const double in = 1.4 * edge_flow(1.95 - 0.1 - 0.3, kSupply_pa - s.p_B);
      const double out = 0.8 * edge_flow(1.95 - 0.1 + 0.05, s.p_A - kTank_pa);
      CHECK_THAT(-kB_m2 * s.v, WithinRel(in, 1e-5));
      CHECK_THAT(-kA_m2 * s.v, WithinRel(out, 1e-5));
      CHECK_THAT(s.servo_flow, WithinRel(-0.5 * (in + out), 1e-5));
    }
  }
}

TEST_CASE("two_chamber: every edge leaks through its clearance, open or covered", "[model]") {
  const double leak = 4e-12;
  Experiment e = driven_rod(2.0);
  e.set("valve_null_leakage", leak);
  const SteadyRod s = steady_rod(e);
  const auto past = [&](double head_pa) { return leak * head_pa; };
  CHECK_THAT(kA_m2 * s.v, WithinRel(edge_flow(2.0, kSupply_pa - s.p_A) + past(kSupply_pa - s.p_A) -
                                        past(s.p_A - kTank_pa),
                                    1e-5));
  CHECK_THAT(kB_m2 * s.v, WithinRel(edge_flow(2.0, s.p_B - kTank_pa) + past(s.p_B - kTank_pa) -
                                        past(kSupply_pa - s.p_B),
                                    1e-5));
}

TEST_CASE("two_chamber: a covered edge leaks the less the more it is covered", "[model]") {
  const double c = 0.3;  // opening at the land's edge [V]
  Experiment e = driven_rod(2.0);
  e.set("valve_null_opening", c);
  const SteadyRod s = steady_rod(e);
  const double covered = c * c / (c + 2.0);
  CHECK_THAT(kA_m2 * s.v, WithinRel(edge_flow(2.0 + c, kSupply_pa - s.p_A) -
                                        edge_flow(covered, s.p_A - kTank_pa),
                                    1e-5));
  CHECK_THAT(kB_m2 * s.v, WithinRel(edge_flow(2.0 + c, s.p_B - kTank_pa) -
                                        edge_flow(covered, kSupply_pa - s.p_B),
                                    1e-5));
}

TEST_CASE("two_chamber: lines throttle as an orifice in series with the edge", "[model]") {
  Experiment e = driven_rod(2.0);
  e.set("valve_line_opening", 3.0);
  const SteadyRod s = steady_rod(e);
  const double both = 1.0 / std::sqrt(1.0 / (2.0 * 2.0) + 1.0 / (3.0 * 3.0));
  CHECK_THAT(kA_m2 * s.v, WithinRel(edge_flow(both, kSupply_pa - s.p_A), 1e-5));
  CHECK_THAT(kB_m2 * s.v, WithinRel(edge_flow(both, s.p_B - kTank_pa), 1e-5));
}

TEST_CASE("two_chamber: the internal leak goes from A to B", "[model]") {
  struct Row {
    double coefficient, laminar;
  };
  for (const Row& row : {Row{0.05, 0.0}, Row{0.0, 3e-12}, Row{0.05, 3e-12}}) {
    Experiment e = driven_rod(2.0);
    e.set("leakage_coefficient", row.coefficient).set("laminar_leakage", row.laminar);
    e.set("external_force", -150.0);  // p_B above p_A
    const SteadyRod s = steady_rod(e);
    const double P_L = s.p_A - s.p_B;
    CAPTURE(P_L, row.coefficient, row.laminar);
    CHECK(std::abs(P_L) > 1e5);
    const double leak =
        row.coefficient * 4.456e-6 * head_root(2.0 * P_L / 847.0) + row.laminar * P_L;
    CHECK_THAT(s.leakage_flow, WithinRel(leak, 1e-5));
    CHECK_THAT(kA_m2 * s.v, WithinRel(edge_flow(2.0, kSupply_pa - s.p_A) - leak, 1e-5));
    CHECK_THAT(kB_m2 * s.v, WithinRel(edge_flow(2.0, s.p_B - kTank_pa) - leak, 1e-5));
  }
}

TEST_CASE("two_chamber: external leaks go from each chamber to the tank", "[model]") {
  for (const bool of_a : {true, false}) {
    Experiment e = driven_rod(2.0);
    e.set(of_a ? "external_leakage_a" : "external_leakage_b", 5e-12).set("tank_pressure", 8e5);
    const SteadyRod s = steady_rod(e);
    const double a = of_a ? 5e-12 * (s.p_A - 8e5) : 0.0;
    const double b = of_a ? 0.0 : 5e-12 * (s.p_B - 8e5);
    CHECK(a + b > 1e-7);
    CHECK_THAT(kA_m2 * s.v, WithinRel(edge_flow(2.0, kSupply_pa - s.p_A) - a, 1e-5));
    CHECK_THAT(kB_m2 * s.v, WithinRel(edge_flow(2.0, s.p_B - 8e5) + b, 1e-5));
  }
}

TEST_CASE("two_chamber: the supply falls by its resistance times what either edge takes",
          "[model]") {
  for (const double direction : {1.0, -1.0}) {
    Experiment e = driven_rod(2.0 * direction);
    e.set("supply_resistance", 1e11).set("supply_capacity", 1e-13);
    const SteadyRod s = steady_rod(e);
    const double flow = direction > 0.0 ? kA_m2 * s.v : -kB_m2 * s.v;
    const double at_valve = kSupply_pa - 1e11 * flow;
    CHECK(at_valve < 0.95 * kSupply_pa);
    CHECK_THAT(flow, WithinRel(edge_flow(2.0, at_valve - (direction > 0.0 ? s.p_A : s.p_B)), 1e-5));
  }
}

TEST_CASE("two_chamber: the supply follows its source with resistance times capacity", "[model]") {
  Experiment e = driven_rod(0.0);  // a closed valve takes no flow
  e.set("supply_resistance", 2e10).set("supply_capacity", 5e-12);
  e.inputs.supply_pressure_pa = Signal::linear({0.0, 1e-6, 1.0}, {4e6, 5e6, 5e6});
  const double tau = 2e10 * 5e-12;
  for (const double t : {0.05, 0.1, 0.3}) {
    e.times_s = {0.0, t};
    REQUIRE(layout_of(e.rig, e.values, {}, 4).supply == 4);
    CHECK_THAT(end_of_run(e).state[4], WithinRel(5e6 - 1e6 * std::exp(-t / tau), 1e-5));
  }
}

TEST_CASE("two_chamber: a recorded tank pressure replaces the parameter", "[model]") {
  Experiment e = driven_rod(2.0);
  e.inputs.tank_pressure_pa = Signal::constant(9e5);
  const SteadyRod s = steady_rod(e);
  CHECK_THAT(kB_m2 * s.v, WithinRel(edge_flow(2.0, s.p_B - 9e5), 1e-5));
}

TEST_CASE("two_chamber: the derivative with volumes, air, stops and hoses, by hand", "[model]") {
  TwoChamberParameters<double> p;
  p.mass_kg = 5.0;
  p.damping_n_s_per_m = 200.0;
  p.stiffness_n_per_m = 3e3;
  p.bulk_modulus_pa = 1.2e9;
  p.density_kg_per_m3 = 847.0;
  p.leakage_smoothing_pa = 1e-3;
  p.area_a_m2 = kA_m2;
  p.area_b_m2 = kB_m2;
  p.stroke_m = 0.2;
  p.dead_volume_a_m3 = 2e-5;
  p.dead_volume_b_m3 = 3e-5;
  p.retracted_position_m = -0.08;
  p.stop_stiffness_n_per_m = 1e7;
  p.stop_damping_s_per_m = 2.0;
  p.gravity_m_per_s2 = 9.81;
  p.external_leakage_a_m3_per_s_pa = 1e-12;
  p.external_leakage_b_m3_per_s_pa = 3e-12;
  p.air_fraction = 0.01;
  p.air_exponent = 1.3;
  p.hose_capacity_a_m3_per_pa = 4e-14;
  p.hose_capacity_b_m3_per_pa = 7e-14;
  p.hose_yield_pa = 2e5;
  p.hose_yield_ratio = 0.05;
  const TwoChamberPlant::Coefficients<double> c(p);
  PresentTerms terms;
  terms.external_leak = terms.air = terms.retracted_position = true;
  terms.hoses = 4;
  const PlantInput<double> in{0.0, 0.0, kSupply_pa, kTank_pa};  // the valve is closed

  const auto modulus = [&](double gauge_pa) {
    const double p_abs = gauge_pa + 101325.0;
    const double share = 0.01 * std::pow(101325.0 / p_abs, 1.0 / 1.3);
    return (share + 0.99) / (share / (1.3 * p_abs) + 0.99 / 1.2e9);
  };
  struct Row {
    double x, v, p_A, p_B, z_A, z_B;
    double stops_n;
  };
  for (const Row& row : {
           Row{0.03, 0.04, 2e6, 3e6, 0.4, -0.3, 0.0},
           Row{0.03, -0.04, 2e6, 3e6, 0.4, -0.3, 0.0},
           // 1 mm into the retracted stop, moving in and moving out; then the same at the extended
           // stop.
           Row{-0.081, -0.1, 2e6, 5e5, 0.2, 0.1, 1e4 * (1.0 + 2.0 * 0.1)},
           Row{-0.081, 0.1, 2e6, 5e5, 0.2, 0.1, 1e4 * (1.0 - 2.0 * 0.1)},
           Row{0.121, 0.1, 2e6, 5e5, 0.2, 0.1, -1e4 * (1.0 + 2.0 * 0.1)},
           Row{0.121, -0.1, 2e6, 5e5, 0.2, 0.1, -1e4 * (1.0 - 2.0 * 0.1)},
           // Moving out so fast that the stop would have to pull.
           Row{0.121, -0.6, 2e6, 5e5, 0.2, 0.1, 0.0},
       }) {
    CAPTURE(row.x, row.v);
    const std::array<double, 6> x{row.x, row.v, row.p_A, row.p_B, row.z_A, row.z_B};
    const auto dx = TwoChamberPlant::derivative(x, in, c, terms);
    CHECK(dx[0] == row.v);
    const double force =
        kA_m2 * row.p_A - kB_m2 * row.p_B - 200.0 * row.v - 3e3 * row.x + row.stops_n - 5.0 * 9.81;
    CHECK_THAT(dx[1], WithinRel(force / 5.0, 1e-9));

    const double flow_a = -kA_m2 * row.v - 1e-12 * (row.p_A - kTank_pa);
    const double flow_b = kB_m2 * row.v - 3e-12 * (row.p_B - kTank_pa);
    const double volume_a = std::max(2e-5 + kA_m2 * (row.x + 0.08), 1e-3 * kA_m2 * 0.2);
    const double volume_b = std::max(3e-5 + kB_m2 * (0.2 - row.x - 0.08), 1e-3 * kB_m2 * 0.2);
    // The fraction that yields in the direction of the pressure change:
    // ((1 + z) / 2)^2 up, ((1 - z) / 2)^2 down.
    const auto yields = [](double z, double flow) {
      return std::pow(0.5 * (1.0 + (flow > 0.0 ? z : -z)), 2);
    };
    const double take_a = volume_a / modulus(row.p_A) + yields(row.z_A, flow_a) * 4e-14;
    const double take_b = volume_b / modulus(row.p_B) + yields(row.z_B, flow_b) * 7e-14;
    CHECK_THAT(dx[2], WithinRel(flow_a / take_a, 1e-9));
    CHECK_THAT(dx[3], WithinRel(flow_b / take_b, 1e-9));

    const auto memory = TwoChamberPlant::hose_rates(x, dx, c, terms);
    const double yield_a = 2e5 + 0.05 * (row.p_A + 101325.0);
    const double yield_b = 2e5 + 0.05 * (row.p_B + 101325.0);
    CHECK_THAT(memory[0], WithinRel((1.0 - yields(row.z_A, flow_a)) * dx[2] / yield_a, 1e-9));
    CHECK_THAT(memory[1], WithinRel((1.0 - yields(row.z_B, flow_b)) * dx[3] / yield_b, 1e-9));

    const double force_read =
        TwoChamberPlant::output(Output::force, x, in, c, terms) - kA_m2 * row.p_A + kB_m2 * row.p_B;
    CHECK_THAT(force_read, WithinAbs(row.stops_n, 1e-6));
  }
}

TEST_CASE("two_chamber: hoses come to their pressure from the tank's or the supply's", "[model]") {
  const PlantInput<double> in{0.0, 0.0, 5e6, 1e6};
  CHECK_THAT(TwoChamberPlant::hose_memory(3e6, in), WithinAbs(0.0, 1e-12));
  CHECK_THAT(TwoChamberPlant::hose_memory(4e6, in), WithinRel(0.5, 1e-12));
  CHECK(TwoChamberPlant::hose_memory(1e6, in) == -1.0);
  CHECK(TwoChamberPlant::hose_memory(6e6, in) == 1.0);
}

TEST_CASE("two_chamber: without a given place zero lies half way between the stops", "[model]") {
  Experiment e = single_rod_rig();
  e.rig.initial = InitialState::given;
  e.inputs.drive = Signal::constant(0.0);
  e.times_s = {0.0};
  e.outputs = {Output::position, Output::pressure_a, Output::pressure_b};
  for (const double side : {-1.0, 1.0}) {
    for (const double press : {-1.0, 1.0}) {
      e.set("initial_position", 0.15 * side);  // the reading is beyond the stop at 0.1
      e.set("initial_pressure_a", press > 0.0 ? 3e6 : 1e6);
      e.set("initial_pressure_b", press > 0.0 ? 1e6 : 3e6);
      const Simulation run = e();
      REQUIRE(run.ok());
      const double push = kA_m2 * run.outputs(0, 1) - kB_m2 * run.outputs(0, 2);
      // Pressed into the stop by the force divided by its stiffness, or just touching it.
      const double depth = push * side > 0.0 ? push / 1e8 : 0.0;
      CAPTURE(side, push);
      CHECK_THAT(run.outputs(0, 0), WithinAbs(0.1 * side + depth, 1e-12));
    }
  }
}

TEST_CASE("two_chamber: of two initial pressures one that was read tells the other", "[model]") {
  Experiment e = single_rod_rig();
  e.rig.initial = InitialState::given;
  e.inputs.drive = Signal::constant(0.0);
  e.set("initial_position", 0.02).set("stiffness", 2e3).set("gravity", 9.81);
  e.set("external_force", 40.0);
  e.times_s = {0.0};
  e.outputs = {Output::pressure_a, Output::pressure_b};
  const double load = 5.0 * 9.81 + 40.0 + 2e3 * 0.02;
  const auto first = [&] {
    const Simulation run = e();
    REQUIRE(run.ok());
    return std::array{run.outputs(0, 0), run.outputs(0, 1)};
  };
  const auto held = [&](const std::array<double, 2>& p) {
    CHECK_THAT(kA_m2 * p[0] - kB_m2 * p[1], WithinRel(load, 1e-9));
  };
  SECTION("neither") {
    const auto p = first();
    held(p);
    CHECK_THAT(p[0] + p[1], WithinRel(kSupply_pa + kTank_pa, 1e-12));
  }
  SECTION("A") {
    e.set("initial_pressure_a", 2e6);
    const auto p = first();
    held(p);
    CHECK_THAT(p[0], WithinRel(2e6, 1e-12));
  }
  SECTION("B") {
    e.set("initial_pressure_b", 2e6);
    const auto p = first();
    held(p);
    CHECK_THAT(p[1], WithinRel(2e6, 1e-12));
  }
}
