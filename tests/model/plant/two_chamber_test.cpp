#include "model/plant/two_chamber.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <vector>

#include "tests/model/end_of_run.hpp"
#include "tests/model/two_chamber_rig.hpp"
#include "tests/support/sanitized.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

using Plant = TwoChamberPlant;

/// Values in the form that the plant uses.
Plant::Coefficients<double> coefficients(const ParameterValues& values) {
  TwoChamberParameters<double> p;
  const auto& fields = kTwoChamberFields<double>;
  for (std::size_t i = 0; i < fields.size(); ++i) p.*(fields[i].member) = values.value[i];
  return Plant::Coefficients<double>(p);
}

/// Power that enters, is stored and is dissipated at one instant [W], or the integrals of these
/// [J].
struct Powers {
  double in = 0.0;          ///< from the source, minus the return flow into the tank [W]
  double held = 0.0;        ///< stored in masses and springs, computed from their states [J]
  double compressed = 0.0;  ///< into the oil of both chambers [W]
  double lost = 0.0;        ///< dissipated; except for hose_lost, no term can be negative [W]
  double hose_lost =
      0.0;  ///< the component of `lost` from the slip of the hoses; positive on average [W]
};

Powers powers(const TwoChamberState& x, double spool_v, const Layout& layout,
              const Plant::Coefficients<double>& p) {
  const PresentTerms& terms = layout.terms;
  const auto at = [&](int state) { return x[static_cast<std::size_t>(state)]; };
  const double P_t = p.tank_pressure_pa;
  const double P_s = layout.supply >= 0 ? at(layout.supply) : p.supply_pressure_pa;
  const double v = x[1];
  const double p_A = x[2];
  const double p_B = x[3];
  const PlantInput<double> in{spool_v, p.external_force_n, P_s, P_t};
  const auto dx = Plant::derivative(x, in, p, terms);
  const auto q = Plant::valve_flows(x, in, p, terms);
  const auto volume = Plant::volumes(x[0], p, terms);
  const double leak = Plant::leakage_flow(x, p, terms);
  const double out_a = (p_A - P_t) * p.external_leakage_a_m3_per_s_pa;
  const double out_b = (p_B - P_t) * p.external_leakage_b_m3_per_s_pa;
  const double taken = q.supply_to_a + q.supply_to_b;

  Powers result;
  result.in = P_s * taken - P_t * (q.a_to_tank + q.b_to_tank + out_a + out_b);
  result.lost = q.supply_to_a * (P_s - p_A) + q.a_to_tank * (p_A - P_t) +
                q.supply_to_b * (P_s - p_B) + q.b_to_tank * (p_B - P_t) + leak * (p_A - p_B) +
                out_a * (p_A - P_t) + out_b * (p_B - P_t) + p.damping_n_s_per_m * v * v +
                friction(v, p, terms) * v;
  result.compressed = p_A * dx[2] * volume[0] / Plant::bulk_modulus(p_A, p, terms) +
                      p_B * dx[3] * volume[1] / Plant::bulk_modulus(p_B, p, terms);
  result.held = 0.5 * p.mass_kg * v * v + 0.5 * p.stiffness_n_per_m * x[0] * x[0] +
                (p.mass_kg * p.gravity_m_per_s2 + p.external_force_n) * x[0];
  if (layout.supply >= 0) {
    const double inflow = (p.supply_pressure_pa - P_s) / p.supply_resistance_pa_s_per_m3;
    result.in += p.supply_pressure_pa * inflow - P_s * taken;
    result.lost += (p.supply_pressure_pa - P_s) * inflow;
    result.held += 0.5 * p.supply_capacity_m3_per_pa * P_s * P_s;
  }
  if (layout.hoses >= 0) {
    // A hose stores C (p - p_h z): a spring with capacity C in series with a slip of p_h z, where z
    // is its memory.
    const auto rates = Plant::hose_rates(x, dx, p, terms);
    for (const int side : {0, 1}) {
      const double C = side == 0 ? p.hose_capacity_a_m3_per_pa : p.hose_capacity_b_m3_per_pa;
      const double slip = p.hose_yield_pa * at(layout.hoses + side);
      const double spring = at(2 + side) - slip;
      const double rate = dx[static_cast<std::size_t>(2 + side)] -
                          p.hose_yield_pa * rates[static_cast<std::size_t>(side)];
      result.held += 0.5 * C * spring * spring;
      result.hose_lost += C * slip * rate;
    }
    result.lost += result.hose_lost;
  }
  const double retracted = Plant::retracted_stop(p, terms);
  for (const int side : {-1, 1}) {
    const double stop = side < 0 ? retracted : retracted + p.stroke_m;
    const double depth = side * (x[0] - stop);
    if (depth <= 0.0) continue;
    const double elastic = p.stop_stiffness_n_per_m * depth;
    const double force =
        stop_force(depth, side * v, p.stop_stiffness_n_per_m, p.stop_damping_s_per_m);
    result.held += 0.5 * elastic * depth;
    result.lost += (force - elastic) * side * v;
  }
  return result;
}

/// Energies of a run [J], by the trapezoidal rule over its samples.
Powers energies(const Experiment& e) {
  const Layout layout = layout_of(e.rig, e.values, {}, Plant::kStates);
  const auto p = coefficients(e.values);
  Experiment part = e;
  part.outputs = {Output::spool};
  TwoChamberState state{};
  Powers sum;
  Powers before;
  for (std::size_t i = 0; i < e.times_s.size(); ++i) {
    // Runs from sample to sample, because states are available only at the end of a run.
    part.times_s = {e.times_s[i]};
    if (i > 0) part.times_s.insert(part.times_s.begin(), e.times_s[i - 1]);
    const EndOfRun run = end_of_run(part, i > 0 ? &state : nullptr);
    state = run.state;
    const double spool_v = run.outputs(0) / p.valve_gain_m_per_v - p.valve_offset_v;
    const Powers now = powers(state, spool_v, layout, p);
    CHECK(now.lost - now.hose_lost >= 0.0);
    const double half = i == 0 ? 0.0 : 0.5 * (e.times_s[i] - e.times_s[i - 1]);
    sum.in += half * (before.in + now.in);
    sum.compressed += half * (before.compressed + now.compressed);
    if (i > 0) sum.held += now.held - before.held;
    sum.lost += half * (before.lost + now.lost);
    sum.hose_lost += half * (before.hose_lost + now.hose_lost);
    before = now;
  }
  return sum;
}

/// Fraction of half a second over which the energy balance is computed.
constexpr double kPart = rigcal::test::kSanitized ? 0.4 : 1.0;

std::vector<double> energy_grid(int intervals) {
  return grid(0.0, 0.5 * kPart, static_cast<int>(kPart * intervals) + 1);
}

/// Work input minus stored and dissipated energy, relative to the work [1].
double gap(const Powers& total) {
  return (total.in - total.held - total.compressed - total.lost) / total.in;
}

double energy_gap(const Experiment& e) { return gap(energies(e)); }

/// Compares the paper's rig as a symmetric two-chamber cylinder and as a load-pressure plant.
double distance_from_load_pressure(double amplitude_m) {
  Experiment both = two_chamber_rig();
  Experiment one;
  for (Experiment* e : {&both, &one}) {
    e->inputs.drive = Signal::sine(amplitude_m, 4.0);
    e->set("valve_frequency", 2000.0).set("valve_damping_ratio", 1.0).set("kp", 300.0);
    e->set("laminar_leakage", 2e-11);
    e->times_s = grid(0.0, 0.5, 101);
    e->outputs = {Output::position, Output::load_pressure, Output::pressure_a, Output::servo_flow};
    e->options.tolerance = 1e-9;
  }
  const Simulation a = both();
  const Simulation b = one();
  REQUIRE(a.ok());
  REQUIRE(b.ok());
  return difference(a.outputs, b.outputs);
}

}  // namespace

TEST_CASE("two_chamber: two equal edges in series are the servo valve of eq. 4", "[model]") {
  const Experiment e = two_chamber_rig();
  const auto p = coefficients(e.values);
  for (const double command_v : {3.0, -2.0}) {
    for (const double P_L : {-2e6, 1.5e6}) {
      const double P_s = p.supply_pressure_pa;
      const std::array<double, Plant::kStates> x{0.0, 0.0, 0.5 * (P_s + P_L), 0.5 * (P_s - P_L)};
      const PlantInput<double> in{command_v, 0.0, P_s, 0.0};
      const double expected = servo_flow(
          p.valve_gain_m_per_v * command_v, P_L, P_s,
          valve_conductance(p.discharge_coefficient, p.area_gradient_m, p.density_kg_per_m3),
          p.leakage_smoothing_pa);
      // The smoothing acts slightly differently on the roots of half the head.
      CHECK_THAT(Plant::output(Output::servo_flow, x, in, p, {}), WithinRel(expected, 1e-7));
    }
  }
}

TEST_CASE("two_chamber: work in is stored or dissipated", "[model]") {
  Experiment e = single_rod_rig();
  e.inputs.drive = Signal::sine(2.0, 2.0);
  e.set("valve_null_leakage", 2e-13).set("coulomb_friction", 60.0).set("gravity", 3.0);
  e.set("leakage_coefficient", 0.02).set("friction_smoothing", 0.01).set("valve_null_opening", 0.1);
  e.set("valve_line_opening", 4.0).set("air_fraction", 0.005).set("stiffness", 2e3);
  e.set("external_leakage_a", 2e-13).set("external_leakage_b", 3e-13).set("external_force", 20.0);
  e.set("laminar_leakage", 3e-13).set("valve_time_constant", 3e-3);
  e.options.tolerance = 1e-9;
  SECTION("rigid hoses, a stiff supply") {}
  SECTION("a supply that gives way") {
    e.set("supply_resistance", 2e10).set("supply_capacity", 5e-12);
  }
  SECTION("into the stop") {
    e.set("retracted_position", -0.195).set("stop_stiffness", 2e6).set("stop_damping", 20.0);
  }
  // The remaining error is that of the trapezoidal rule, which falls with the square of the sample
  // spacing.
  e.times_s = energy_grid(2000);
  const double coarse = energy_gap(e);
  e.times_s = energy_grid(8000);
  const double fine = energy_gap(e);
  CHECK_THAT(fine, WithinAbs(0.0, 1e-6));
  CHECK(std::abs(fine) < std::abs(coarse) / 8.0 + 1e-8);
}

TEST_CASE("two_chamber: what hoses take in they give back or turn into heat", "[model]") {
  Experiment e = single_rod_rig();
  e.inputs.drive = Signal::sine(2.0, 2.0);
  e.set("hose_capacity_a", 3e-13).set("hose_capacity_b", 2e-13).set("hose_yield", 6e5);
  e.set("supply_resistance", 2e10).set("supply_capacity", 5e-12);
  e.options.tolerance = 1e-9;
  // Where a pressure reverses, the power jumps, and the trapezoidal rule is of first order.
  e.times_s = energy_grid(8000);
  const Powers total = energies(e);
  CHECK_THAT(gap(total), WithinAbs(0.0, 1e-5));
  CHECK(total.hose_lost > 0.0);
}

TEST_CASE("two_chamber: the load-pressure plant is its limit where the volumes do not vary",
          "[model]") {
  // The stiffness of the chambers is an even function of travel, so the difference falls with its
  // square.
  const double far = distance_from_load_pressure(4e-3);
  const double near = distance_from_load_pressure(1e-3);
  CHECK(near < far / 10.0);
  CHECK(near < 2e-3);
}

TEST_CASE("two_chamber: mirrored, it does the mirrored thing", "[model]") {
  Experiment e = single_rod_rig();
  e.set("retracted_position", -0.08).set("coulomb_friction", 30.0).set("gravity", 4.0);
  e.set("gain_supply_to_a", 1.2).set("overlap_b_to_tank", 0.1).set("external_leakage_a", 1e-13);
  e.outputs = {Output::position, Output::pressure_a, Output::pressure_b};
  Experiment m = e;
  m.inputs.drive = Signal::square(-2.0, 2.0);
  m.set("area_a", 1.2e-4)
      .set("area_b", 2.0e-4)
      .set("dead_volume_a", 3e-5)
      .set("dead_volume_b", 2e-5);
  m.set("retracted_position", -0.12).set("gravity", -4.0);
  m.set("gain_supply_to_a", 1.0).set("gain_supply_to_b", 1.2);
  m.set("overlap_b_to_tank", 0.0).set("overlap_a_to_tank", 0.1);
  m.set("external_leakage_a", 0.0).set("external_leakage_b", 1e-13);
  const Simulation run = e();
  const Simulation mirrored = m();
  REQUIRE(run.ok());
  REQUIRE(mirrored.ok());
  // The equations are the same, only rounding differs.
  const auto close = [](const auto& a, const auto& b) { return peak(a - b) < 1e-9 * peak(a); };
  CHECK(close(run.outputs.col(0), -mirrored.outputs.col(0)));
  CHECK(close(run.outputs.col(1), mirrored.outputs.col(2)));
  CHECK(close(run.outputs.col(2), mirrored.outputs.col(1)));
}

TEST_CASE("two_chamber: a stop holds the piston and gives way by force over stiffness", "[model]") {
  Experiment e = single_rod_rig();
  e.inputs.drive = Signal::constant(5.0);
  e.set("retracted_position", 0.005).set("stroke", 0.19);
  e.times_s = grid(0.0, 3.0, 3001);
  e.outputs = {Output::position, Output::velocity, Output::pressure_a, Output::pressure_b};
  const Simulation run = e();
  REQUIRE(run.ok());
  const auto x = run.outputs.col(0);
  CHECK_THAT(x(0), WithinAbs(0.005, 1e-5));  // zero is beyond the stop
  CHECK_THAT(x.maxCoeff(), WithinAbs(0.195, 2e-4));
  const double push = 2.0e-4 * run.outputs(3000, 2) - 1.2e-4 * run.outputs(3000, 3);
  CHECK_THAT(x(3000) - 0.195, WithinRel(push / 1e8, 1e-3));
  CHECK_THAT(run.outputs(3000, 2), WithinRel(4.4e6, 1e-3));
  CHECK_THAT(run.outputs(3000, 3), WithinRel(1e5, 1e-2));
  CHECK_THAT(run.outputs(3000, 1), WithinAbs(0.0, 1e-6));
  // The stop does not limit the steps: the arrival and 2 s at rest take only a few hundred.
  CHECK(run.steps + run.rejected_steps < 3000);
}

TEST_CASE("two_chamber: steady speeds are those of orifices in series with the piston", "[model]") {
  Experiment e = single_rod_rig();
  e.inputs.drive = Signal::constant(2.0);
  e.set("damping", 0.0).set("retracted_position", 0.0).set("mass", 1.0);
  e.times_s = {0.0, 3.0};  // the ringing has decayed
  e.outputs = {Output::velocity, Output::pressure_a, Output::pressure_b};
  const Simulation run = e();
  REQUIRE(run.ok());
  // A_A v = K sqrt(P_s - p_A), A_B v = K sqrt(p_B - P_t), A_A p_A = A_B p_B.
  const double A = 2.0e-4;
  const double B = 1.2e-4;
  const double K = 0.6 * 0.02075 * 4e-6 * 2.0 * std::sqrt(2.0 / 847.0);
  const double v = std::sqrt((4.4e6 - 1e5 * B / A) / (A * A / (K * K) + B * B * B / (A * K * K)));
  CHECK_THAT(run.outputs(1, 0), WithinRel(v, 1e-3));
  CHECK_THAT(run.outputs(1, 1) * A, WithinRel(run.outputs(1, 2) * B, 1e-3));
}

TEST_CASE("two_chamber: a closed valve that leaks balances the chambers", "[model]") {
  Experiment e = single_rod_rig();
  e.rig.initial = InitialState::given;
  e.inputs.drive = Signal::constant(0.0);
  e.set("retracted_position", 0.0).set("initial_position", 0.25);  // at rest on the extended stop
  e.set("initial_pressure_a", 4.4e6).set("initial_pressure_b", 1e5);
  e.times_s = {0.0, 100.0};
  e.outputs = {Output::pressure_a, Output::pressure_b};
  for (const char* leak : {"valve_null_leakage", "valve_null_opening"}) {
    Experiment each = e;
    each.set(leak, leak == std::string("valve_null_leakage") ? 1e-13 : 0.05);
    const Simulation run = each();
    REQUIRE(run.ok());
    CHECK_THAT(run.outputs(1, 0), WithinRel(2.25e6, 1e-3));
    CHECK_THAT(run.outputs(1, 1), WithinRel(2.25e6, 1e-3));
  }
}

TEST_CASE("two_chamber: a supply that gives way falls by resistance times flow", "[model]") {
  Experiment e = single_rod_rig();
  e.inputs.drive = Signal::constant(2.0);
  e.set("retracted_position", 0.0);
  e.set("supply_resistance", 2e10).set("supply_capacity", 1e-13);
  e.times_s = {0.0, 0.4};
  e.outputs = {Output::velocity, Output::pressure_a, Output::servo_flow};
  const Simulation soft = e();
  REQUIRE(soft.ok());
  const double flow = 2.0e-4 * soft.outputs(1, 0);
  Experiment stiff = single_rod_rig();
  stiff.inputs.drive = Signal::constant(2.0);
  stiff.set("retracted_position", 0.0).set("supply_pressure", 4.4e6 - 2e10 * flow);
  stiff.times_s = e.times_s;
  stiff.outputs = e.outputs;
  const Simulation same = stiff();
  REQUIRE(same.ok());
  CHECK_THAT(soft.outputs(1, 0), WithinRel(same.outputs(1, 0), 1e-3));
}

TEST_CASE("two_chamber: the spool is never faster than its limit", "[model]") {
  for (const bool second_order : {false, true}) {
    Experiment e = single_rod_rig();
    e.inputs.drive = Signal::square(5.0, 2.0);
    if (second_order) {
      e.set("valve_frequency", 400.0).set("valve_damping_ratio", 0.8);
    } else {
      e.set("valve_time_constant", 2e-3);
    }
    e.set("valve_rate_limit", 100.0);
    e.times_s = grid(0.0, 0.2, 201);
    e.outputs = {Output::spool};
    const Simulation run = e();
    REQUIRE(run.ok());
    const Eigen::VectorXd spool_v = run.outputs.col(0) / 4e-6;
    const double fastest = (spool_v.tail(200) - spool_v.head(200)).cwiseAbs().maxCoeff() / 1e-3;
    CHECK_THAT(fastest, WithinRel(100.0, 1e-3));
    CHECK_THAT(spool_v(200), WithinRel(5.0, 0.02));
  }
}

TEST_CASE("two_chamber: hoses that yield damp the ringing of a piston", "[model]") {
  Experiment e = single_rod_rig();
  e.inputs.drive = Signal::constant(0.0);
  e.rig.initial = InitialState::given;
  e.set("damping", 0.0).set("initial_velocity", 0.05);
  e.set("initial_pressure_a", 1.8e6).set("initial_pressure_b", 3e6);
  e.times_s = grid(0.0, 0.5, 2001);
  e.outputs = {Output::velocity};
  const Simulation rigid = e();
  e.set("hose_capacity_a", 3e-13).set("hose_capacity_b", 3e-13);
  // Has only the component that is proportional to the pressure: 3 bar at 25 bar absolute.
  Experiment braided = e;
  const Simulation braid = braided.set("hose_yield_ratio", 0.12)();
  const Simulation soft = e.set("hose_yield", 3e5)();
  REQUIRE(rigid.ok());
  REQUIRE(soft.ok());
  REQUIRE(braid.ok());
  // Nothing else dissipates energy: the valve is closed, and there is no friction.
  CHECK(peak(rigid.outputs.bottomRows(500)) > 0.045);
  CHECK(peak(soft.outputs.bottomRows(500)) < 0.025);
  CHECK(peak(braid.outputs.bottomRows(500)) < 0.025);
}

TEST_CASE("two_chamber: at rest the pressures hold the load", "[model]") {
  Experiment e = single_rod_rig();
  e.inputs.drive = Signal::constant(0.0);
  e.set("gravity", 9.81).set("external_force", 40.0);
  e.times_s = {0.0, 1.0};
  e.outputs = {Output::position, Output::pressure_a, Output::pressure_b, Output::velocity};
  const Simulation run = e();
  REQUIRE(run.ok());
  CHECK_THAT(run.outputs(0, 1) + run.outputs(0, 2), WithinRel(4.5e6, 1e-12));
  CHECK_THAT(2.0e-4 * run.outputs(0, 1) - 1.2e-4 * run.outputs(0, 2),
             WithinRel(5.0 * 9.81 + 40.0, 1e-9));
  CHECK(peak(run.outputs.row(1) - run.outputs.row(0)) < 1.0);  // Pa: no motion
  SECTION("a pressure that was read tells the other") {
    e.rig.initial = InitialState::given;
    e.set("initial_pressure_a", 2e6).set("pressure_a_offset", 1e5).set("pressure_a_gain", 1.9);
    const Simulation given = e();
    REQUIRE(given.ok());
    CHECK_THAT(given.outputs(0, 1), WithinRel(2e6, 1e-12));
    CHECK_THAT(1.2e-4 * given.outputs(0, 2), WithinRel(2.0e-4 * 1e6 - 5.0 * 9.81 - 40.0, 1e-9));
  }
}
