#include "model/solver/steady_state.hpp"

#include <catch2/catch.hpp>
#include <functional>
#include <string>

#include "model/plant/layout.hpp"
#include "model/plant/load_pressure.hpp"
#include "tests/model/two_chamber_rig.hpp"
#include "tests/support/sanitized.hpp"

using namespace rigcal::model;

namespace {

constexpr double kStepTolerance = 1e-6;
constexpr int kPeriods = 41;

/// One state and its sensitivity to a parameter, as a function of the period. Within a period, the
/// values at all instants differ only by a factor.
using Value = std::function<Dual<1>(double period)>;

struct Foreseen {
  /// Number of periods until the rest could be extrapolated; all of them if it never could.
  double period = 0.0;
  bool reached = false;
  Dual<1> end{0.0};
};

/// @param sign  factor from each period to the next
Foreseen watch(const Value& value, double sign = 1.0) {
  constexpr double kPeriod = 0.1;
  const double end_s = kPeriods * kPeriod;
  SteadyState<1, 1> state(SampledPeriod{kPeriod, 100, sign < 0.0}, end_s);
  ErrorNorm<1, 1> norm(1, {1e-3}, {1.0}, kStepTolerance, 50.0);
  while (state.next_look_s() < end_s) {
    const double period = state.next_look_s() / kPeriod;
    const double whole = std::floor(period + 1e-9);
    const double here =
        std::pow(sign, whole) * (1.0 + 0.3 * std::sin(2.0 * kPi * (period - whole)));
    const std::array x{value(period) * here};
    norm.see(x);
    if (!state.look(x, norm)) continue;
    Dual<1> end = value(whole);
    if (!state.reached()) {
      const long to_come = std::lround(kPeriods - whole);
      end = end + (end - value(whole - 1.0)) * state.growth(to_come);
    }
    return {period, state.reached(), end * std::pow(sign, kPeriods)};
  }
  return {kPeriods, false, Dual<1>(0.0)};
}

/// 1 + size ratio^period, with its sensitivity to `ratio`.
Value decay(double size, double ratio) {
  return [=](double period) {
    Dual<1> x(1.0 + size * std::pow(ratio, period));
    x.derivative.set(0, size * period * std::pow(ratio, period - 1.0));
    return x;
  };
}

Value operator+(const Value& a, const Value& b) {
  return [=](double period) { return a(period) + b(period); };
}

/// Checks that the extrapolated end agrees with that of `value` within `tolerances` of a step.
void check_end(const Foreseen& found, const Value& value, double tolerances, double sign = 1.0) {
  const Dual<1> end = value(kPeriods) * std::pow(sign, kPeriods);
  CHECK(std::abs(found.end.value - end.value) < tolerances * kStepTolerance);
  CHECK(std::abs(found.end.derivative[0] - end.derivative[0]) <
        500.0 * tolerances * kStepTolerance);
}

std::vector<int> indices(const Experiment& e, const std::vector<const char*>& keys) {
  std::vector<int> result;
  for (const char* key : keys) result.push_back(parameter_index(e.rig.plant, key));
  return result;
}

struct Both {
  Simulation all;       ///< every period is simulated
  Simulation foreseen;  ///< extrapolated, as simulate() does by default
};

Both both(Experiment e) {
  Both result;
  result.foreseen = e();
  e.options.periodic_steady_state = false;
  result.all = e();
  REQUIRE(result.all.ok());
  REQUIRE(result.foreseen.ok());
  return result;
}

/// Checks that the extrapolated run is about as exact as the complete one, compared with a run at a
/// much smaller tolerance.
void check_as_exact(const Experiment& e, const Both& runs) {
  Experiment tight = e;
  tight.options.tolerance = 1e-9;
  tight.options.periodic_steady_state = false;
  const Simulation exact = tight();
  REQUIRE(exact.ok());
  CHECK(difference(exact.outputs, runs.foreseen.outputs) <
        3.0 * difference(exact.outputs, runs.all.outputs) + 3.0 * kStepTolerance);
  for (std::size_t i = 0; i < e.outputs.size(); ++i) {
    CAPTURE(output_name(e.outputs[i]));
    CHECK(difference(exact.sensitivities[i], runs.foreseen.sensitivities[i]) <
          3.0 * difference(exact.sensitivities[i], runs.all.sensitivities[i]) +
              500.0 * kStepTolerance);
  }
}

}  // namespace

TEST_CASE("steady_state: a constant is known after a period, a decay when it is gone", "[model]") {
  const Foreseen constant = watch(decay(0.0, 0.5));
  CHECK(constant.period < 1.2);
  CHECK(constant.reached);
  check_end(constant, decay(0.0, 0.5), 1.0);
  const Foreseen gone = watch(decay(1.0, 1e-4));  // before three periods have passed
  CHECK(gone.period < 3.0);
  CHECK(gone.reached);
  check_end(gone, decay(1.0, 1e-4), 1.0);
}

TEST_CASE("steady_state: a slow decay is foreseen, its sensitivity too", "[model]") {
  for (const double ratio : {0.9, 0.6, -0.5}) {
    CAPTURE(ratio);
    // A negative ratio changes the sign from period to period, not within one.
    const Value value = ratio > 0.0 ? decay(0.1, ratio) : Value([=](double period) {
      const double whole = std::floor(period + 1e-9);
      return decay(0.1, ratio)(whole);
    });
    const Foreseen found = watch(value);
    CHECK(found.period < 6.0);
    CHECK_FALSE(found.reached);
    check_end(found, value, 0.1);
  }
}

TEST_CASE("steady_state: what comes back with the other sign is known as soon", "[model]") {
  for (const Value& value : {decay(0.0, 0.5), decay(1.0, 1e-4), decay(0.1, 0.9), decay(0.1, 0.6)}) {
    const Foreseen plain = watch(value);
    const Foreseen reversed = watch(value, -1.0);
    REQUIRE(reversed.period < kPeriods);
    CHECK(reversed.period == Approx(plain.period).margin(1.1));
    CHECK(reversed.reached == plain.reached);
    check_end(reversed, value, 1.0, -1.0);
  }
  // Something that does not reverse with the inputs is extrapolated as it is, or not at all.
  const Value there_and_back = [](double period) {
    return Dual<1>(std::pow(-1.0, std::floor(period + 1e-9)));
  };
  const Foreseen same = watch(there_and_back, -1.0);
  CHECK_FALSE(same.reached);
  if (same.period < kPeriods) CHECK(same.end.value == Approx(1.0).epsilon(kStepTolerance));
}

TEST_CASE("steady_state: two modes are foreseen when the faster one is gone", "[model]") {
  const Value two = decay(0.1, 0.9) + decay(0.1, 0.2);
  const Foreseen found = watch(two);
  CHECK(found.period > 6.0);
  CHECK(found.period < 15.0);
  check_end(found, two, 3.0);
  const Value alike = decay(0.1, 0.9) + decay(0.1, 0.8);
  const Foreseen late = watch(alike);
  CHECK(late.period > 30.0);
  if (late.period < kPeriods) check_end(late, alike, 3.0);
}

TEST_CASE("steady_state: what grows or wanders is never known", "[model]") {
  CHECK(watch(decay(1e-4, 1.02)).period == kPeriods);
  const Value beat = [](double period) { return Dual<1>(1.0 + 0.01 * std::sin(1.7 * period)); };
  CHECK(watch(beat).period == kPeriods);
  // A drift of a tenth of a tolerance per period is not detectable, but over forty periods it would
  // be four tolerances.
  const Value creep = [](double period) { return Dual<1>(1.0 + 0.1 * kStepTolerance * period); };
  const Foreseen found = watch(creep);
  if (found.period < kPeriods) check_end(found, creep, 1.5);
}

TEST_CASE("steady_state: a run read from its last periods is as exact as one simulated to the end",
          "[model]") {
  struct Case {
    std::string name;
    Experiment e;
    double share;  ///< largest fraction of the steps
  };
  std::vector<Case> cases;
  const std::vector<const char*> keys{"mass", "bulk_modulus", "valve_gain", "damping"};
  for (const auto& [name, drive] :
       {std::pair{"sine", Signal::sine(0.005, 10.0)}, {"square", Signal::square(0.005, 10.0)}}) {
    Experiment quick;  // settles within a few periods
    quick.inputs.drive = drive;
    quick.set("kp", 400.0);
    quick.times_s = grid(0.0, 3.0, 3001);
    cases.push_back({std::string("quick loop, ") + name, quick, 0.3});
    Experiment one_sided = quick;  // half periods are not the negative of their predecessors
    one_sided.set("valve_offset", 0.1).set("external_force", 200.0);
    cases.push_back({std::string("one-sided, ") + name, one_sided, 0.5});
    Experiment slow = quick;  // moves a fifth of the remaining distance in each period
    slow.set("kp", 60.0);
    cases.push_back({std::string("slow loop, ") + name, slow, 0.6});
    Experiment states = quick;
    states.set("ki", 400.0).set("kd", 0.5).set("derivative_filter", 600.0);
    states.set("valve_frequency", 500.0).set("valve_damping_ratio", 0.7).set("output_limit", 5.0);
    cases.push_back({std::string("with all states of a loop, ") + name, states, 0.85});
    Experiment sampled = quick;
    sampled.set("sample_time", 4e-3);
    cases.push_back({std::string("sampled controller, ") + name, sampled, 0.5});
    Experiment chambers = two_chamber_rig();
    chambers.inputs.drive = drive;
    chambers.set("kp", 400.0).set("coulomb_friction", 100.0).set("valve_time_constant", 4e-3);
    chambers.times_s = quick.times_s;
    cases.push_back({std::string("two chambers, ") + name, chambers, 0.7});
  }
  for (std::size_t k = 0; k < cases.size(); k += rigcal::test::kSanitized ? 4 : 1) {
    auto& [name, e, share] = cases[k];
    CAPTURE(name);
    e.outputs = {Output::position, Output::load_pressure, Output::command, Output::servo_flow};
    e.free = indices(e, keys);
    e.options.tolerance = kStepTolerance;
    const Both runs = both(e);
    const auto& [all, foreseen] = runs;
    CHECK(static_cast<double>(foreseen.steps) < share * static_cast<double>(all.steps));
    check_as_exact(e, runs);
  }
}

TEST_CASE("steady_state: more columns than one pass takes, the same for each", "[model]") {
  Experiment e;
  e.inputs.drive = Signal::sine(0.005, 10.0);
  e.set("kp", 400.0);
  e.times_s = grid(0.0, 3.0, 3001);
  e.free = indices(e, {"mass", "bulk_modulus", "valve_gain", "damping", "supply_pressure",
                       "piston_area", "total_volume", "density", "leakage_coefficient", "kp"});
  const Both runs = both(e);
  CHECK(runs.foreseen.steps < runs.all.steps / 3);
  check_as_exact(e, runs);
}

TEST_CASE("steady_state: records that begin or end anywhere", "[model]") {
  Experiment e;
  e.inputs.drive = Signal::square(0.005, 3.0);
  e.set("kp", 400.0);
  for (const auto& times_s : {grid(0.0123, 6.0123, 6001), grid(0.0, 5.777, 5778),
                              grid(-0.4, 4.0, 4401), grid(0.0, 1.001, 1002)}) {
    e.times_s = times_s;
    const auto [all, foreseen] = both(e);
    CHECK(difference(all.outputs, foreseen.outputs) < 1e-5);
  }
}

TEST_CASE("steady_state: without periodic inputs runs are the same to the bit", "[model]") {
  Experiment e;
  e.set("kp", 400.0);
  e.times_s = grid(0.0, 3.0, 3001);
  e.inputs.drive = Signal::chirp(0.005, 1.0, 5.0, 3.0, false);
  const auto [all, foreseen] = both(e);
  CHECK(all.outputs == foreseen.outputs);
  CHECK(all.steps == foreseen.steps);
}

TEST_CASE("steady_state: reversed inputs reverse a rig that is taken for reversible", "[model]") {
  Experiment e;
  e.set("stiffness", 5e4).set("transport_delay", 3e-3).set("output_limit", 3.0);
  e.set("ki", 400.0).set("kd", 0.5).set("derivative_filter", 600.0);
  e.set("valve_frequency", 500.0).set("valve_damping_ratio", 0.7).set("valve_rate_limit", 900.0);
  e.set("valve_dead_band", 0.1).set("valve_null_leakage", 5e-12).set("laminar_leakage", 8e-12);
  e.set("coulomb_friction", 150.0).set("stribeck_friction", 90.0).set("stribeck_velocity", 0.02);
  e.options.periodic_steady_state = false;
  e.outputs.clear();
  const auto terms = [](const Experiment& of) {
    return layout_of(of.rig, of.values, of.free, LoadPressurePlant::kStates).terms;
  };
  for (const Output output : kAllOutputs) {
    if (LoadPressurePlant::reversible(output, terms(e))) e.outputs.push_back(output);
  }
  CHECK(e.outputs.size() == kAllOutputs.size() - 2);
  const auto table = parameter_table(PlantKind::load_pressure);
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!table[i].can_be_fitted || table[i].kind == ParameterKind::sensor) continue;
    Experiment with = e;
    with.free = {static_cast<int>(i)};
    if (LoadPressurePlant::reversible(Output::position, terms(with)))
      e.free.push_back(static_cast<int>(i));
  }
  CHECK(e.free.size() > 20);
  for (const bool square : {false, true}) {
    const auto drive = [square](double amplitude) {
      return square ? Signal::square(amplitude, 5.0) : Signal::sine(amplitude, 5.0);
    };
    e.inputs.drive = drive(0.01);
    const Simulation run = e();
    e.inputs.drive = drive(-0.01);
    const Simulation reversed = e();
    REQUIRE(run.ok());
    REQUIRE(reversed.ok());
    CHECK(run.outputs == -reversed.outputs);  // rounding is symmetric, too
    for (std::size_t k = 0; k < e.outputs.size(); ++k) {
      CAPTURE(output_name(e.outputs[k]));
      CHECK(run.sensitivities[k] == -reversed.sensitivities[k]);
    }
  }
  for (const char* key : {"valve_offset", "external_force"}) {
    CAPTURE(key);
    Experiment pushed = e;
    pushed.set(key, 1.0);
    CHECK_FALSE(LoadPressurePlant::reversible(Output::position, terms(pushed)));
    Experiment free = e;
    free.free = indices(free, {key});
    CHECK_FALSE(LoadPressurePlant::reversible(Output::position, terms(free)));
  }
}

TEST_CASE("steady_state: whole periods where halves do not reverse all that is asked for",
          "[model]") {
  Experiment e;
  e.inputs.drive = Signal::square(0.005, 10.0);
  e.set("kp", 400.0);
  e.times_s = grid(0.0, 3.0, 3001);
  const auto check = [](const Experiment& of) {
    const Both runs = both(of);
    check_as_exact(of, runs);
    return runs.foreseen.steps;
  };
  const long steps = check(e);
  Experiment chambers = e;  // their pressures swap, around half the supply pressure
  chambers.outputs = {Output::position, Output::pressure_a, Output::pressure_b};
  CHECK(check(chambers) > steps);
  Experiment offset = e;  // zero, but the sensitivity to it is requested
  offset.free = indices(offset, {"valve_offset", "external_force"});
  CHECK(check(offset) > steps);
}
