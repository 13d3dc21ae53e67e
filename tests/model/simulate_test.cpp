#include "model/simulate.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "tests/model/rig.hpp"

using namespace rigcal::model;
using Catch::Contains;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

Experiment paper(const Signal& drive, double seconds = 1.0) {
  Experiment e;
  e.inputs.drive = drive;
  e.times_s = grid(0.0, seconds, 101);
  return e;
}

/// A valve that is driven by a recorded command instead of a loop.
Experiment open_loop(const Signal& command_v, double seconds = 1.0) {
  Experiment e = paper(command_v, seconds);
  e.rig.controller = ControllerKind::none;
  return e;
}

/// A signal with 40 samples in one second. A `scale` of -1 mirrors it.
Signal forty_samples(bool straight, double scale = 1.0) {
  std::vector<double> value;
  value.reserve(40);
  for (int i = 0; i < 40; ++i)
    value.push_back(scale * (0.01 * std::sin(0.37 * i) + 0.002 * (i % 3)));
  const auto times = grid(0.0, 1.0, 40);
  return straight ? Signal::linear(times, value) : Signal::held(times, value);
}

Simulation ok(const Experiment& e) {
  Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  return run;
}

}  // namespace

TEST_CASE("simulate: two methods agree on every waveform", "[model]") {
  struct Row {
    const char* name;
    Signal drive;
  };
  for (const Row& row : {
           Row{"sine", Signal::sine(0.02, 2.0)},
           Row{"square", Signal::square(0.005, 5.0)},
           Row{"chirp", Signal::chirp(0.01, 0.5, 10.0, 0.8, false)},
           Row{"logarithmic chirp", Signal::chirp(0.01, 0.5, 10.0, 0.8, true)},
           Row{"held", forty_samples(false)},
           Row{"linear", forty_samples(true)},
       }) {
    CAPTURE(row.name);
    Experiment e = paper(row.drive);
    e.set("kp", 800.0);
    e.options.tolerance = 1e-8;
    const Simulation implicit = ok(e);
    e.options.method = Method::dopri5;
    // The error of each run is some hundred local errors of 1e-8, relative to the peak of each
    // state.
    CHECK(difference(implicit.outputs, ok(e).outputs) < 2e-5);
    e.options.method = Method::rosenbrock;
    e.options.tolerance = 1e-5;
    CHECK(difference(implicit.outputs, ok(e).outputs) < 1e-2);
  }
}

namespace {

struct Term {
  const char* name;
  std::vector<std::pair<const char*, double>> values;
  std::vector<std::pair<const char*, double>> neutral;  ///< values for which the term vanishes
};

const std::vector<Term>& terms() {
  static const std::vector<Term> rows{
      {"first-order valve", {{"valve_time_constant", 0.005}}, {}},
      {"second-order valve", {{"valve_frequency", 600.0}, {"valve_damping_ratio", 0.7}}, {}},
      {"valve offset", {{"valve_offset", 0.2}}, {{"valve_offset", 0.0}}},
      {"dead band", {{"valve_dead_band", 0.3}}, {{"valve_dead_band", 0.0}}},
      {"null leakage", {{"valve_null_leakage", 5e-12}}, {{"valve_null_leakage", 0.0}}},
      {"Coulomb", {{"coulomb_friction", 300.0}}, {{"coulomb_friction", 0.0}}},
      {"Stribeck",
       {{"stribeck_friction", 200.0}, {"stribeck_velocity", 0.02}},
       {{"stribeck_friction", 0.0}}},
      {"external force", {{"external_force", 800.0}}, {{"external_force", 0.0}}},
      {"laminar leakage", {{"laminar_leakage", 5e-12}}, {{"laminar_leakage", 0.0}}},
      {"transport delay", {{"transport_delay", 0.013}}, {{"transport_delay", 0.0}}},
      {"spring", {{"stiffness", 75e3}}, {{"stiffness", 0.0}}},
      {"integral", {{"ki", 300.0}}, {{"ki", 0.0}}},
      {"derivative",
       {{"kd", 2.0}, {"derivative_filter", 100.0}},
       {{"kd", 0.0}, {"derivative_filter", 100.0}}},
      {"limit", {{"output_limit", 3.0}}, {{"output_limit", kInfinity}}},
      {"sampled", {{"sample_time", 0.002}}, {}},
  };
  return rows;
}

Experiment with(Experiment e, const std::vector<std::pair<const char*, double>>& values) {
  for (const auto& [key, value] : values) e.set(key, value);
  return e;
}

}  // namespace

TEST_CASE("simulate: two methods agree on every optional term", "[model]") {
  Experiment base = paper(Signal::sine(0.02, 2.0), 0.5);
  base.set("kp", 300.0);
  base.options.tolerance = 1e-8;
  base.options.method = Method::rosenbrock;
  const Simulation plain = ok(base);
  for (const Term& term : terms()) {
    CAPTURE(term.name);
    Experiment e = with(base, term.values);
    const Simulation implicit = ok(e);
    e.options.method = Method::dopri5;
    CHECK(difference(implicit.outputs, ok(e).outputs) < 2e-5);
    CHECK(difference(implicit.outputs, plain.outputs) > 1e-4);  // the term has an effect
  }
}

TEST_CASE("simulate: an optional term at its neutral value leaves the plain model", "[model]") {
  Experiment base = paper(Signal::square(0.01, 4.0), 0.5);
  base.options.tolerance = 1e-8;
  const Simulation plain = ok(base);
  for (const Term& term : terms()) {
    if (term.neutral.empty()) continue;
    CAPTURE(term.name);
    CHECK(difference(plain.outputs, ok(with(base, term.neutral)).outputs) < 1e-5);
  }
  // Valve and sampling have no neutral value, but they approach the plain model as they become
  // faster.
  const std::vector<Term> fast{
      {"lag", {{"valve_time_constant", 1e-6}}, {}},
      {"second order", {{"valve_frequency", 1e6}, {"valve_damping_ratio", 1.0}}, {}}};
  for (const Term& term : fast) {
    CAPTURE(term.name);
    // A lag of 2 us shifts the phase of the ringing pressure, at 587 rad/s, by 1.2e-3 rad.
    CHECK(difference(plain.outputs, ok(with(base, term.values)).outputs) < 5e-3);
  }
}

TEST_CASE("simulate: the mirrored reference gives the mirrored run", "[model]") {
  for (const Term& term : terms()) {
    CAPTURE(term.name);
    if (std::string(term.name) == "valve offset" || std::string(term.name) == "external force") {
      continue;  // these two terms are not symmetric
    }
    Experiment e = with(paper(forty_samples(false)), term.values);
    e.outputs = {Output::position, Output::load_pressure, Output::servo_flow, Output::command};
    const Simulation run = ok(e);
    e.inputs.drive = forty_samples(false, -1.0);
    CHECK(run.outputs == -ok(e).outputs);  // rounding is symmetric, too
  }
}

TEST_CASE("simulate: the paper's exact symmetry leaves position and command unchanged", "[model]") {
  // m, b, k, beta and P_s are multiplied by s; k_sv and C_leak are divided by the root of s. The
  // smoothing scales with P.
  const double s = 4.0;
  Experiment e = paper(Signal::square(0.01, 2.0));
  e.set("stiffness", 2e4);
  e.outputs = {Output::position, Output::command, Output::load_pressure};
  e.options.tolerance = 1e-9;
  const Simulation run = ok(e);
  for (const char* key :
       {"mass", "damping", "stiffness", "bulk_modulus", "supply_pressure", "leakage_smoothing"}) {
    e.set(key, e.values[key] * s);
  }
  for (const char* key : {"valve_gain", "leakage_coefficient"}) {
    e.set(key, e.values[key] / std::sqrt(s));
  }
  Simulation scaled = ok(e);
  scaled.outputs.col(2) /= s;
  CHECK(difference(run.outputs, scaled.outputs) < 1e-6);
}

TEST_CASE("simulate: a constant command ends in the orifice law's velocity", "[model]") {
  // Q_L = A v with P_L = b v / A, if nothing leaks.
  Experiment e = open_loop(Signal::constant(1.0), 2.0);
  e.set("leakage_coefficient", 0.0);
  e.outputs = {Output::velocity,   Output::load_pressure, Output::spool,
               Output::servo_flow, Output::work_flow,     Output::leakage_flow};
  const Simulation run = ok(e);
  const auto last = run.outputs.row(100);
  const double v = last(0);
  const double P_L = 1000.0 * v / 1.62e-3;
  const double spool = 0.0406e-3;
  // The ringing has decayed to exp(-b / 2m * 2 s) = 8e-6.
  CHECK_THAT(last(1), WithinRel(P_L, 1e-4));
  CHECK_THAT(v,
             WithinRel(0.6 * 0.02075 * spool * std::sqrt((6.2e6 - P_L) / 847.0) / 1.62e-3, 1e-4));
  CHECK(last(2) == spool);
  CHECK_THAT(last(3), WithinRel(last(4), 1e-4));
  CHECK(run.outputs.col(5) == Eigen::VectorXd::Zero(101));  // a coefficient of 0 means no leak
}

TEST_CASE("simulate: flow and power balance", "[model]") {
  Experiment e = paper(Signal::sine(0.02, 1.0), 1.0);
  e.times_s = grid(0.0, 1.0, 20001);
  e.set("stiffness", 2e4).set("laminar_leakage", 1e-12).set("external_force", 300.0);
  e.outputs = {Output::position,     Output::velocity,  Output::load_pressure, Output::servo_flow,
               Output::leakage_flow, Output::work_flow, Output::force};
  e.options.tolerance = 1e-9;
  const Simulation run = ok(e);
  const auto at = [&](Eigen::Index i, int k) { return run.outputs(i, k); };
  const double dt = 1.0 / 20000.0;
  const double compliance = 2.46888e-4 / (4.0 * 689e6);
  double worst = 0.0;
  double work_in = 0.0;
  double dissipated = 0.0;
  double against_load = 0.0;
  for (Eigen::Index i = 1; i < 20000; ++i) {
    const double rate = (at(i + 1, 2) - at(i - 1, 2)) / (2.0 * dt);
    const double surplus = at(i, 3) - at(i, 4) - at(i, 5);
    worst = std::max(worst, std::abs(surplus - compliance * rate));
    work_in += at(i, 2) * (at(i, 3) - at(i, 4)) * dt;  // power that reaches the chambers
    dissipated += 1000.0 * at(i, 1) * at(i, 1) * dt;
    against_load += 300.0 * at(i, 1) * dt;
  }
  // The central difference of a 587 rad/s mode over 50 us has an error of (omega dt)^2 / 6 =
  // 1.4e-4.
  CHECK(worst < 5e-4 * peak(run.outputs.col(3)));
  const auto energy = [&](Eigen::Index i) {
    return 0.5 * 85.0 * at(i, 1) * at(i, 1) + 0.5 * 2e4 * at(i, 0) * at(i, 0) +
           0.5 * compliance * at(i, 2) * at(i, 2);
  };
  const double stored = energy(20000) - energy(0);
  CHECK_THAT(work_in, WithinAbs(stored + dissipated + against_load, 1e-3 * dissipated));
  CHECK(dissipated > 0.1);
  // Without dry friction the rod force is A P_L.
  CHECK(peak(run.outputs.col(6) - 1.62e-3 * run.outputs.col(2)) < 1e-9);
}

TEST_CASE("simulate: chamber pressures are half of supply plus or minus load", "[model]") {
  Experiment e = paper(Signal::sine(0.02, 1.0));
  e.outputs = {Output::load_pressure, Output::pressure_a, Output::pressure_b};
  const Simulation run = ok(e);
  CHECK(peak(run.outputs.col(1) - run.outputs.col(2) - run.outputs.col(0)) < 1e-6);
  CHECK(peak((run.outputs.col(1) + run.outputs.col(2)).array() - 6.2e6) < 1e-6);
}

TEST_CASE("simulate: the laminar path is linear in the pressure", "[model]") {
  Experiment e = paper(Signal::sine(0.02, 2.0));
  e.set("leakage_coefficient", 0.0).set("laminar_leakage", 2e-11);
  e.outputs = {Output::load_pressure, Output::leakage_flow};
  const Simulation run = ok(e);
  CHECK(peak(run.outputs.col(0)) > 1e4);
  CHECK(peak(run.outputs.col(1) - 2e-11 * run.outputs.col(0)) < 1e-20);
}

TEST_CASE("simulate: within its overlap the valve passes nothing", "[model]") {
  Experiment e = open_loop(Signal::sine(0.5, 2.0));
  e.set("valve_dead_band", 0.6);
  e.outputs = {Output::position, Output::servo_flow, Output::spool};
  CHECK(peak(ok(e).outputs) == 0.0);
  // With a null shift of 0.2 V, it opens only on one side.
  e.set("valve_offset", 0.2);
  const Simulation run = ok(e);
  CHECK(run.outputs.col(2).minCoeff() == 0.0);
  CHECK_THAT(run.outputs.col(2).maxCoeff(), WithinRel(0.1 * 0.0406e-3, 0.01));
}

TEST_CASE("simulate: Coulomb friction holds a load below it", "[model]") {
  Experiment e = open_loop(Signal::constant(0.0), 2.0);
  e.rig.initial = InitialState::given;
  e.set("leakage_coefficient", 0.35).set("external_force", 200.0);
  e.outputs = {Output::velocity, Output::position};
  // Because of the leak, a free piston sinks at a speed that the orifice and the load determine.
  const double sinks = ok(e).outputs(100, 1);
  CHECK(sinks < -1e-3);
  e.set("coulomb_friction", 300.0).set("friction_smoothing", 1e-6);
  // With smoothed friction the piston creeps: v_0 atanh(200 / 300) = 0.8 um/s.
  CHECK_THAT(ok(e).outputs(100, 0), WithinAbs(-1e-6 * std::atanh(200.0 / 300.0), 1e-8));
  CHECK(std::abs(ok(e).outputs(100, 1)) < 1e-5);
}

TEST_CASE("simulate: a transport delay shifts the run exactly", "[model]") {
  // The reference rests until its recorded motion begins, so the time before does not matter.
  std::vector<double> value(41, 0.0);
  for (std::size_t i = 1; i < value.size(); ++i) value[i] = 0.01 * std::sin(0.4 * double(i));
  Experiment e = paper(Signal::held(grid(0.0, 1.0, 41), value));
  const double delay = 0.25;
  e.times_s = grid(0.0, 0.75, 76);
  const Simulation prompt = ok(e);
  e.set("transport_delay", delay);
  for (double& t : e.times_s) t += delay;
  e.times_s.insert(e.times_s.begin(), 0.0);
  const Simulation late = ok(e);
  // The steps differ only before the first motion, and both runs are within the default tolerance.
  CHECK(difference(prompt.outputs, late.outputs.bottomRows(76)) < 1e-5);
}

TEST_CASE("simulate: a constant force deflects the spring", "[model]") {
  Experiment e = open_loop(Signal::constant(0.0), 5.0);
  e.set("stiffness", 5e4).set("external_force", 500.0).set("laminar_leakage", 1e-10);
  e.outputs = {Output::position, Output::load_pressure, Output::force};
  const Simulation run = ok(e);
  // The leak equalises the chambers, so k x = -F.
  CHECK_THAT(run.outputs(100, 0), WithinRel(-0.01, 1e-3));
  CHECK(std::abs(run.outputs(100, 1)) < 100.0);
}

TEST_CASE("simulate: a recorded force and supply act as the parameters do", "[model]") {
  for (const InitialState initial : {InitialState::rest, InitialState::given}) {
    Experiment by_parameter = paper(Signal::sine(0.02, 2.0));
    by_parameter.rig.initial = initial;
    by_parameter.set("external_force", 700.0).set("supply_pressure", 5e6);
    Experiment by_signal = paper(Signal::sine(0.02, 2.0));
    by_signal.rig.initial = initial;
    by_signal.inputs.external_load = Signal::constant(700.0);
    by_signal.inputs.supply_pressure_pa = Signal::constant(5e6);
    const Simulation run = ok(by_signal);
    CHECK(difference(ok(by_parameter).outputs, run.outputs) < 1e-12);
    // A piston that starts from its reading starts in balance.
    if (initial == InitialState::given)
      CHECK_THAT(run.outputs(0, 1), WithinRel(700.0 / by_signal.values["piston_area"], 1e-12));
  }
}

TEST_CASE("simulate: an error of the spool acts as a null shift, and as a command that varies",
          "[model]") {
  Experiment by_parameter = paper(Signal::sine(0.02, 2.0));
  by_parameter.set("valve_offset", 0.2);
  by_parameter.options.tolerance = 1e-8;
  Experiment by_signal = paper(Signal::sine(0.02, 2.0));
  by_signal.options.tolerance = 1e-8;
  by_signal.inputs.spool_error = Signal::constant(0.2);
  CHECK(difference(ok(by_parameter).outputs, ok(by_signal).outputs) < 1e-5);
  const std::vector<double> times{0.0, 0.3, 1.0};
  Experiment by_command = open_loop(Signal::linear(times, {0.0, 1.5, -0.5}));
  Experiment by_error = open_loop(Signal::linear(times, {0.0, 1.0, -1.0}));
  by_error.inputs.spool_error = Signal::linear(times, {0.0, 0.5, 0.5});
  for (Experiment* each : {&by_command, &by_error}) {
    each->set("valve_time_constant", 1e-4);
    each->free = {parameter_index(PlantKind::load_pressure, "mass")};
    each->options.tolerance = 1e-8;
  }
  const Simulation command = ok(by_command);
  const Simulation error = ok(by_error);
  // The error acts downstream of the valve's lag, which hardly matters here.
  CHECK(difference(command.outputs, error.outputs) < 1e-3);
  CHECK(difference(command.sensitivities[0], error.sensitivities[0]) < 1e-2);
}

TEST_CASE("simulate: sensor offsets shift their output and nothing else", "[model]") {
  Experiment e = paper(Signal::sine(0.02, 2.0));
  e.outputs = {Output::position,   Output::load_pressure, Output::pressure_a,
               Output::pressure_b, Output::force,         Output::command};
  const Simulation plain = ok(e);
  const char* keys[] = {"position_offset", "load_pressure_offset", "pressure_a_offset",
                        "pressure_b_offset", "force_offset"};
  for (int k = 0; k < 5; ++k) {
    CAPTURE(keys[k]);
    Experiment shifted = e;
    shifted.set(keys[k], 0.5);
    Eigen::MatrixXd expected = plain.outputs;
    expected.col(k).array() += 0.5;
    CHECK(ok(shifted).outputs == expected);
  }
}

TEST_CASE("simulate: equilibria stay put", "[model]") {
  CHECK(peak(ok(paper(Signal::constant(0.0))).outputs) == 0.0);
  // The rig is at rest under pressure, force and spring, at the recorded position minus its offset.
  Experiment e = paper(Signal::constant(0.0));
  e.rig.initial = InitialState::given;
  e.inputs.drive = Signal::constant(0.02);
  e.set("leakage_coefficient", 0.0).set("stiffness", 5e4).set("external_force", 200.0);
  e.set("position_offset", 0.003).set("initial_position", 0.023);
  e.set("initial_load_pressure", (5e4 * 0.02 + 200.0) / 1.62e-3);
  const Simulation run = ok(e);
  CHECK(peak(run.outputs.col(0).array() - 0.023) < 1e-12);
}

TEST_CASE("simulate: without an initial load pressure it starts in equilibrium", "[model]") {
  Experiment e = paper(Signal::constant(0.02));
  e.rig.initial = InitialState::given;
  e.set("leakage_coefficient", 0.0).set("stiffness", 5e4).set("external_force", 200.0);
  e.set("initial_position", 0.02);
  const Simulation run = ok(e);
  CHECK(peak(run.outputs.col(0).array() - 0.02) < 1e-12);
  CHECK_THAT(run.outputs(0, 1), WithinRel((5e4 * 0.02 + 200.0) / 1.62e-3, 1e-14));
}

TEST_CASE("simulate: initial values are readings, their sensors' offsets included", "[model]") {
  Experiment e = paper(Signal::constant(0.0));
  e.times_s = {0.0};
  e.rig.initial = InitialState::given;
  e.outputs = {Output::position, Output::load_pressure, Output::pressure_a};
  e.set("initial_position", 0.01).set("position_offset", 0.002);
  e.set("initial_load_pressure", 2e5).set("load_pressure_offset", 1e4);
  const Simulation run = ok(e);
  CHECK_THAT(run.outputs(0, 0), WithinRel(0.01, 1e-14));
  CHECK_THAT(run.outputs(0, 1), WithinRel(2e5, 1e-14));
  CHECK_THAT(run.outputs(0, 2), WithinRel(0.5 * (6.2e6 + 1.9e5), 1e-14));
}

TEST_CASE("simulate: a closed loop that starts in motion gets no kick", "[model]") {
  // Filter and valve start in equilibrium with the loop, so neither command nor spool jumps at the
  // first sample.
  for (const bool sampled : {false, true}) {
    CAPTURE(sampled);
    Experiment e = paper(Signal::constant(0.03));
    e.rig.initial = InitialState::given;
    e.set("kd", 5.0).set("derivative_filter", 200.0).set("initial_position", 0.01);
    e.set("valve_frequency", 500.0).set("valve_damping_ratio", 0.8);
    if (sampled) e.set("sample_time", 0.001);
    e.outputs = {Output::command, Output::spool};
    const Simulation run = ok(e);
    CHECK_THAT(run.outputs(0, 0), WithinRel(78.74 * 0.02, 1e-12));
    CHECK_THAT(run.outputs(0, 1), WithinRel(78.74 * 0.02 * 0.0406e-3, 1e-12));
  }
}

TEST_CASE("simulate: a sample on an edge sees the new half period", "[model]") {
  for (const double frequency_hz : {3.0, 7.0, 10.0}) {
    Experiment e = open_loop(Signal::square(1.0, frequency_hz));
    e.times_s.clear();
    for (int k = 0; k < 12; ++k) e.times_s.push_back(k * (0.5 / frequency_hz));
    e.outputs = {Output::command};
    const Simulation run = ok(e);
    for (int k = 0; k < 12; ++k) {
      CAPTURE(frequency_hz, k);
      CHECK(run.outputs(k, 0) == (k % 2 == 0 ? 1.0 : -1.0));
    }
  }
}

TEST_CASE("simulate: the clock may start anywhere", "[model]") {
  const std::vector<double> value{0.0, 0.01, -0.01, 0.02, 0.0, 0.015};
  Experiment e;
  e.inputs.drive = Signal::held(grid(0.0, 0.5, 6), value);
  e.times_s = grid(0.0, 0.9, 901);
  e.outputs = {Output::position, Output::command};
  const Simulation reference = ok(e);
  struct Row {
    double start_s, tolerance;
  };
  // The run is the same within its tolerance. At 1.7e9 s, time stamps are rounded to 2.4e-7 s, and
  // signals change by their full size within about 10 ms.
  for (const Row& row : {Row{-3.0, 1e-6}, Row{0.1, 1e-6}, Row{1e5, 1e-6}, Row{1.7e9, 1e-4}}) {
    CAPTURE(row.start_s);
    Experiment later = e;
    auto times = grid(0.0, 0.5, 6);
    for (double& t : times) t += row.start_s;
    for (double& t : later.times_s) t += row.start_s;
    later.inputs.drive = Signal::held(times, value);
    CHECK(difference(reference.outputs, ok(later).outputs) < row.tolerance);
  }
  // A waveform has its own clock: the phase at the first sample follows from the sample's time.
  Experiment sine = open_loop(Signal::sine(1.0, 1.0));
  sine.outputs = {Output::command};
  sine.times_s = {0.25, 0.5};
  CHECK_THAT(ok(sine).outputs(0, 0), WithinRel(1.0, 1e-14));
}

TEST_CASE("simulate: a single sample is the initial state", "[model]") {
  Experiment e = paper(Signal::sine(0.02, 1.0));
  e.times_s = {0.3};
  e.rig.initial = InitialState::given;
  e.set("initial_position", 0.004).set("initial_load_pressure", 2e5);
  const Simulation run = ok(e);
  REQUIRE(run.outputs.rows() == 1);
  CHECK(run.outputs(0, 0) == 0.004);
  CHECK(run.outputs(0, 1) == 2e5);
}

TEST_CASE("simulate: a short pulse after a long rest is not leapt over", "[model]") {
  const Signal pulse = Signal::held({0.0, 1.5, 1.51}, {0.0, 5.0, 0.0});
  Experiment e = open_loop(pulse, 3.0);
  e.times_s = {0.0, 1.5, 3.0};
  const double travel = ok(e).outputs(2, 0);
  e.times_s = grid(0.0, 3.0, 3001);
  const Simulation dense = ok(e);
  // Approximately the flow at 5 V for 10 ms divided by the area: 1.3 mm.
  CHECK(travel > 5e-4);
  CHECK_THAT(travel, WithinRel(dense.outputs(3000, 0), 1e-6));
  CHECK(dense.outputs(1500, 0) == 0.0);
}

TEST_CASE("simulate: follows a recording of thousands of samples", "[model]") {
  const auto times = grid(0.0, 5.0, 5001);
  std::vector<double> value;
  value.reserve(times.size());
  for (const double t : times) value.push_back(0.02 * std::sin(2.0 * kPi * t));
  Experiment e;
  e.times_s = grid(0.0, 5.0, 501);
  e.inputs.drive = Signal::sine(0.02, 1.0);
  const Simulation smooth = ok(e);
  e.inputs.drive = Signal::linear(times, value);
  const Simulation straight = ok(e);
  // Straight lines over 1 ms deviate by (2 pi dt)^2 / 8 = 5e-6 from a 1 Hz sine.
  CHECK(difference(smooth.outputs.leftCols(1), straight.outputs.leftCols(1)) < 2e-5);
  e.inputs.drive = Signal::held(times, value);
  const Simulation held = ok(e);
  // A hold of 1 ms acts as a delay of 0.5 ms: pi 1e-3 of the sine, or half of that because the loop
  // is slower.
  const double lag = difference(smooth.outputs.leftCols(1), held.outputs.leftCols(1));
  CHECK(lag < 4e-3);
  CHECK(lag > 1e-3);
  CHECK(held.steps < 60000);
}

TEST_CASE("simulate: a command that changes sooner than the step would end costs no accuracy",
          "[model]") {
  const auto changes = grid(0.0, 0.2, 1001);
  std::vector<double> command;
  for (const double t : changes)
    command.push_back(0.5 * std::sin(9.0 * t) + 0.2 * std::sin(61.0 * t));
  Experiment e;
  e.rig.controller = ControllerKind::none;
  e.times_s = grid(0.0, 0.2, 101);
  e.inputs.drive = Signal::held(changes, command);
  for (const char* key : {"mass", "bulk_modulus", "valve_gain", "leakage_coefficient"})
    e.free.push_back(parameter_index(PlantKind::load_pressure, key));
  for (const double leak : {0.0, 0.35, 10.0}) {  // the leak is stiff with the last value
    CAPTURE(leak);
    e.set("leakage_coefficient", leak);
    e.options.tolerance = 1e-6;
    const Simulation run = ok(e);
    e.options.tolerance = 1e-9;
    const Simulation exact = ok(e);
    CHECK(difference(exact.outputs, run.outputs) < 5e-6);
    for (std::size_t k = 0; k < run.sensitivities.size(); ++k)
      CHECK(difference(exact.sensitivities[k], run.sensitivities[k]) < 1e-3);
  }
}

TEST_CASE("simulate: a sample's value does not depend on the samples beside it", "[model]") {
  for (const Signal& drive : {Signal::square(0.01, 2.0), Signal::sine(0.02, 2.0)}) {
    Experiment e = paper(drive);
    e.times_s = grid(0.0, 1.0, 21);  // half a period is a whole number of samples
    const Simulation few = ok(e);
    e.times_s = grid(0.0, 1.0, 1001);
    const Simulation many = ok(e);
    for (Eigen::Index i = 0; i < 21; ++i) {
      CHECK(few.outputs.row(i).isApprox(many.outputs.row(50 * i), 1e-12));
    }
    CHECK(few.steps == many.steps);
  }
}

TEST_CASE("simulate: a sensitivity that only decays ends at zero, not below what is normal",
          "[model]") {
  Experiment e;
  e.rig.initial = InitialState::given;
  e.set("initial_position", 0.01);
  e.inputs.drive = Signal::held({0.0}, {0.0});
  e.times_s = grid(0.0, 200.0, 201);
  e.free = {parameter_index(PlantKind::load_pressure, "position_offset"),
            parameter_index(PlantKind::load_pressure, "mass")};
  const Simulation run = ok(e);
  for (const Eigen::MatrixXd& by : run.sensitivities) {
    for (Eigen::Index i = 0; i < by.size(); ++i)
      CHECK(std::fpclassify(by.data()[i]) != FP_SUBNORMAL);
  }
  volatile double small = 1e-300;
  CHECK(small * 1e-10 > 0.0);  // after the run, subnormal numbers exist again
}

TEST_CASE("simulate: repeats to the bit", "[model]") {
  Experiment e = paper(Signal::square(0.02, 5.0));
  e.free = {parameter_index(PlantKind::load_pressure, "mass"),
            parameter_index(PlantKind::load_pressure, "leakage_coefficient")};
  const Simulation first = ok(e);
  const Simulation second = ok(e);
  CHECK(first.outputs == second.outputs);
  CHECK(first.sensitivities == second.sensitivities);
  CHECK(first.steps == second.steps);
}

TEST_CASE("simulate: leakage and low frequency cost few steps", "[model]") {
  // Guards against stiffness: an explicit method takes 1e5 steps (paper.md).
  for (const Signal& drive : {Signal::sine(0.0508, 0.1), Signal::square(0.0508, 0.1)}) {
    Experiment e = paper(drive, 10.0);
    e.set("leakage_coefficient", 1.35);
    e.options.tolerance = 1e-4;
    CHECK(ok(e).steps < 1000);
    for (const char* key : {"mass", "bulk_modulus", "valve_gain", "leakage_coefficient"}) {
      e.free.push_back(parameter_index(PlantKind::load_pressure, key));
    }
    CHECK(ok(e).steps < 1500);
  }
}

TEST_CASE("simulate: a failed run has a status, a time, a reason and no numbers", "[model]") {
  struct Row {
    const char* name;
    std::function<void(Experiment&)> spoil;
    SimulationStatus status;
    const char* reason;
  };
  std::atomic<bool> stop{true};
  for (const Row& row : {
           Row{"NaN", [](auto& e) { e.set("mass", kNaN); }, SimulationStatus::bad_parameters,
               "mass"},
           Row{"plant value never set", [](auto& e) { e.values.value[0] = 0.0; },
               SimulationStatus::bad_parameters, "mass"},
           Row{"below its limit", [](auto& e) { e.set("bulk_modulus", -1.0); },
               SimulationStatus::bad_parameters, "bulk_modulus = -1 Pa"},
           Row{"above its limit", [](auto& e) { e.set("transport_delay", 11.0); },
               SimulationStatus::bad_parameters, "[0, 10]"},
           Row{"infinite", [](auto& e) { e.set("kp", kInfinity); },
               SimulationStatus::bad_parameters, "kp"},
           Row{"a valve without damping", [](auto& e) { e.set("valve_frequency", 500.0); },
               SimulationStatus::bad_parameters, "valve_damping_ratio"},
           Row{"a derivative without filter", [](auto& e) { e.set("kd", 1.0); },
               SimulationStatus::bad_parameters, "derivative_filter"},
           Row{"steps", [](auto& e) { e.options.max_steps = 10; }, SimulationStatus::too_many_steps,
               "10 steps"},
           Row{"time", [](auto& e) { e.options.max_seconds = 1e-9; }, SimulationStatus::out_of_time,
               "not finished after"},
           Row{"cancel", [&stop](auto& e) { e.options.cancel = &stop; },
               SimulationStatus::cancelled, "request"},
           Row{"a hole in the recording",
               [](auto& e) {
                 e.inputs.drive = Signal::held({0.0, 0.6, 0.7}, {0.0, kNaN, 0.0});
               },
               SimulationStatus::not_finite, "finite"},
       }) {
    CAPTURE(row.name);
    Experiment e = paper(Signal::sine(0.02, 1.0));
    e.free = {0, 1};
    row.spoil(e);
    const Simulation run = e();
    CAPTURE(run.reason, to_string(run.status));
    CHECK(run.status == row.status);
    CHECK_THAT(run.reason, Contains(row.reason));
    CHECK(run.failed_at_s >= 0.0);
    CHECK(run.failed_at_s <= 1.0);
    CHECK(run.outputs.size() == 0);
    CHECK(run.sensitivities.empty());
  }
}

TEST_CASE("simulate: an unstable loop stays within what the supply can drive", "[model]") {
  // The orifice flow reverses at P_s, so v < A P_s / b for any command, and the run stays finite.
  Experiment e = paper(Signal::sine(0.02, 1.0), 2.0);
  e.set("sample_time", 0.05).set("kp", 1e8).set("output_limit", kInfinity);
  e.outputs = {Output::velocity, Output::position};
  const Simulation run = ok(e);
  CHECK(peak(run.outputs.col(0)) < 1.62e-3 * 6.2e6 / 1000.0);
  CHECK(peak(run.outputs.col(1)) > 0.05);  // far from the reference, so the loop is indeed unstable
}

TEST_CASE("simulate: tells where in time a run failed", "[model]") {
  Experiment e = paper(Signal::held({100.0, 100.6, 100.7}, {0.0, kNaN, 0.0}));
  for (double& t : e.times_s) t += 100.0;
  CHECK_THAT(e().failed_at_s, WithinAbs(100.6, 1e-6));
}

TEST_CASE("simulate: refuses a broken contract", "[model]") {
  const auto refuses = [](const std::function<void(Experiment&)>& spoil) {
    Experiment e;
    spoil(e);
    CHECK_THROWS_AS(e(), std::invalid_argument);
  };
  refuses([](auto& e) { e.times_s = {}; });
  refuses([](auto& e) { e.times_s = {0.0, 0.0}; });
  refuses([](auto& e) { e.times_s = {kNaN}; });
  refuses([](auto& e) { e.times_s = {0.0, kInfinity}; });
  refuses([](auto& e) { e.free = {-1}; });
  refuses([](auto& e) { e.free = {999}; });
  refuses(
      [](auto& e) { e.free = {parameter_index(PlantKind::load_pressure, "leakage_smoothing")}; });
  refuses([](auto& e) { e.values.value.pop_back(); });
  refuses([](auto& e) { e.options.tolerance = 0.0; });
  refuses([](auto& e) { e.options.tolerance = kNaN; });
  refuses([](auto& e) { e.options.max_steps = 0; });
  refuses([](auto& e) { e.options.max_seconds = -1.0; });
}

TEST_CASE("output_name: each has its own name, with a unit", "[model]") {
  std::vector<std::string_view> names;
  for (const Output output : kAllOutputs) {
    const std::string_view name = output_name(output);
    CHECK(std::find(names.begin(), names.end(), name) == names.end());
    CHECK(name.find('_') != std::string_view::npos);
    names.push_back(name);
  }
}

TEST_CASE("simulate: eight steps a period of the input, even where it moves nothing", "[model]") {
  Experiment e = open_loop(Signal::sine(0.5, 10.0), 5.0);
  e.set("valve_dead_band", 0.6);
  e.options.periodic_steady_state = false;
  CHECK(ok(e).steps >= 8 * 10 * 5);
}

TEST_CASE("simulate: an output that is not finite is a failure, if it is the only sample too",
          "[model]") {
  Experiment e = open_loop(Signal::constant(kNaN));
  e.times_s = {0.0};
  e.outputs = {Output::command};
  const Simulation run = e();
  CHECK(run.status == SimulationStatus::not_finite);
  CHECK(run.outputs.size() == 0);
}
