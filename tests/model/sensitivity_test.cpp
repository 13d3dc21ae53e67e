#include "tests/model/sensitivity.hpp"

using namespace rigcal::model;

namespace {

Signal recorded(bool straight) {
  std::vector<double> value;
  value.reserve(21);
  for (int i = 0; i < 21; ++i) value.push_back(0.004 * std::sin(0.9 * i) + 0.001 * (i % 3));
  const auto times = grid(0.0, 0.2, 21);
  return straight ? Signal::linear(times, value) : Signal::held(times, value);
}

/// Every waveform, every combination of terms that changes the layout, and every parameter at least
/// once.
const std::vector<Scenario>& scenarios() {
  const NamedValues offsets{{"position_offset", 1e-3},
                            {"load_pressure_offset", 1e5},
                            {"pressure_a_offset", 1e5},
                            {"pressure_b_offset", -1e5},
                            {"force_offset", 20.0},
                            {"position_gain", 1.05},
                            {"load_pressure_gain", 0.97},
                            {"pressure_a_gain", 1.02},
                            {"pressure_b_gain", 0.95},
                            {"force_gain", 1.1},
                            {"acceleration_gain", 1.05},
                            {"acceleration_offset", 5.0},
                            {"payload_mass", 20.0},
                            {"payload_frequency", 150.0},
                            {"payload_damping_ratio", 0.2},
                            {"payload_acceleration_gain", 0.9},
                            {"payload_acceleration_offset", -5.0}};
  const NamedValues lags{{"position_lag", 4e-3},
                         {"load_pressure_lag", 3e-3},
                         {"pressure_a_lag", 2e-3},
                         {"pressure_b_lag", 5e-3},
                         {"force_lag", 6e-3},
                         {"acceleration_lag", 4e-3},
                         {"payload_acceleration_lag", 5e-3},
                         {"payload_mass", 20.0},
                         {"payload_frequency", 150.0},
                         {"payload_damping_ratio", 0.2}};
  static const std::vector<Scenario> rows{
      {"square, plain", Signal::square(0.004, 8.0), {{"stiffness", 5e4}}},
      {"square, delayed", Signal::square(0.004, 8.0), {{"transport_delay", 0.0083}}},
      {"square, delayed, PID, second-order valve",
       Signal::square(0.004, 8.0),
       {{"transport_delay", 0.0083},
        {"ki", 2000.0},
        {"kd", 3.0},
        {"derivative_filter", 200.0},
        {"valve_frequency", 700.0},
        {"valve_damping_ratio", 0.7}}},
      {"sine, first-order valve, integral, small terms",
       Signal::sine(0.006, 9.0),
       {{"ki", 3000.0},
        {"valve_time_constant", 0.003},
        {"valve_offset", 0.15},
        {"valve_dead_band", 0.2},
        {"valve_null_leakage", 5e-12},
        {"laminar_leakage", 8e-12},
        {"external_force", 400.0},
        {"transport_delay", 0.004}}},
      {"chirp, PID at its limit, dry friction",
       Signal::chirp(0.01, 4.0, 30.0, 0.15, false),
       {{"ki", 2000.0},
        {"kd", 2.0},
        {"derivative_filter", 300.0},
        {"output_limit", 3.0},
        {"coulomb_friction", 150.0},
        {"stribeck_friction", 90.0},
        {"stribeck_velocity", 0.02},
        {"friction_smoothing", 5e-3},
        {"transport_delay", 0.003}}},
      {"chirp, friction with pre-sliding",
       Signal::chirp(0.004, 4.0, 30.0, 0.15, false),
       {{"coulomb_friction", 150.0},
        {"stribeck_friction", 90.0},
        {"stribeck_velocity", 0.02},
        {"bristle_stiffness", 2e6},
        {"bristle_damping", 2e3},
        {"seal_friction", 2e-5},
        {"leakage_resistance", 2e11},
        {"derivative_filter", 300.0},
        {"velocity_feedforward", 20.0},
        {"acceleration_feedforward", 0.3}}},
      {"sine, friction that follows the lubricant film",
       Signal::sine(0.003, 12.0),
       {{"coulomb_friction", 100.0},
        {"stribeck_friction", 400.0},
        {"stribeck_velocity", 0.1},
        {"bristle_stiffness", 2e6},
        {"bristle_damping", 2e3},
        {"friction_smoothing", 0.012},
        {"film_velocity", 0.04},
        {"film_growth_time", 0.01},
        {"film_decay_time", 0.02},
        {"film_dwell_time", 0.02}}},
      {"logarithmic chirp, derivative, first-order valve",
       Signal::chirp(0.005, 4.0, 30.0, 0.15, true),
       {{"kd", 2.0}, {"derivative_filter", 300.0}, {"valve_time_constant", 0.002}}},
      {"held, continuous loop, delayed", recorded(false), {{"transport_delay", 0.0043}}},
      {"linear, sampled PID, second-order valve, delayed",
       recorded(true),
       {{"ki", 2000.0},
        {"kd", 2.0},
        {"derivative_filter", 300.0},
        {"sample_time", 0.0025},
        {"valve_frequency", 700.0},
        {"valve_damping_ratio", 0.9},
        {"output_limit", 8.0},
        {"transport_delay", 0.0043}}},
      {"held, sampled P", recorded(false), {{"sample_time", 0.0025}}},
      {"given state, PID, valve",
       Signal::sine(0.005, 6.0),
       {{"initial_position", 2e-3},
        {"initial_velocity", 0.02},
        {"initial_load_pressure", 3e5},
        {"position_offset", 4e-4},
        {"transport_delay", 0.004},
        {"kd", 2.0},
        {"derivative_filter", 200.0},
        {"valve_time_constant", 0.004}},
       ControllerKind::pid,
       InitialState::given},
      {"given state, sampled PD, valve",
       Signal::sine(0.005, 6.0),
       {{"initial_position", 2e-3},
        {"kd", 2.0},
        {"derivative_filter", 200.0},
        {"sample_time", 0.0025},
        {"valve_time_constant", 0.004}},
       ControllerKind::pid,
       InitialState::given},
      {"loop on force",
       Signal::sine(4e3, 9.0),
       {{"force_kp", 5e-5},
        {"force_ki", 1e-3},
        {"force_kd", 2e-8},
        {"derivative_filter", 300.0},
        {"stiffness", 5e5},
        {"load_gradient", -5e4},
        {"load_curvature", 1e9},
        {"transport_delay", 0.004}},
       ControllerKind::pid,
       InitialState::rest,
       false,
       Feedback::force},
      {"loop on load pressure, from a given state",
       Signal::sine(2e6, 9.0),
       {{"load_pressure_kp", 8e-8},
        {"load_pressure_ki", 2e-6},
        {"load_pressure_kd", 4e-11},
        {"derivative_filter", 300.0},
        {"initial_integral", 0.2},
        {"initial_position", 2e-3}},
       ControllerKind::pid,
       InitialState::given,
       false,
       Feedback::load_pressure},
      {"loop on acceleration, recorded loads",
       Signal::sine(30.0, 9.0),
       {{"acceleration_kp", 9e-3},
        {"acceleration_ki", 0.2},
        {"acceleration_kd", 4e-6},
        {"derivative_filter", 300.0},
        {"pressure_feedback", 2e-8}},
       ControllerKind::pid,
       InitialState::rest,
       true,
       Feedback::acceleration},
      {"three-variable control, recorded loads",
       Signal::sine(0.006, 9.0),
       {{"ki", 500.0},
        {"velocity_kp", 2.0},
        {"acceleration_kp", 3e-3},
        {"reference_frequency", 150.0},
        {"reference_damping_ratio", 0.8},
        {"velocity_feedforward", 20.0},
        {"acceleration_feedforward", 0.1},
        {"pressure_feedback", 2e-8},
        {"valve_time_constant", 2e-3},
        {"transport_delay", 0.004}},
       ControllerKind::pid,
       InitialState::rest,
       true,
       Feedback::three_variable},
      {"three-variable control of an acceleration, sampled",
       Signal::sine(10.0, 9.0),
       {{"velocity_kp", 2.0},
        {"acceleration_kp", 3e-3},
        {"reference_frequency", 12.0},
        {"reference_damping_ratio", 0.7},
        {"sample_time", 0.0025},
        {"valve_time_constant", 2e-3},
        {"initial_position", 2e-3},
        {"transport_delay", 0.0043}},
       ControllerKind::pid,
       InitialState::given,
       false,
       Feedback::three_variable_acceleration,
       Before::rest},
      {"command, no controller, recorded loads, offsets", Signal::sine(3.0, 10.0), offsets,
       ControllerKind::none, InitialState::rest, true},
      {"command, warm oil",
       Signal::sine(3.0, 9.0),
       {{"reference_temperature", 313.15},
        {"oil_temperature", 338.15},
        {"viscosity_decay", 0.03},
        {"thermal_expansion", 7e-4},
        {"bulk_modulus_decay", 5.5e-3},
        {"laminar_leakage", 2e-11}},
       ControllerKind::none},
      {"command, load by a table",
       Signal::square(2.0, 10.0),
       {{"load_table_from", 0.0},
        {"load_table_to", 1.2e-3},
        {"load_0", 300.0},
        {"load_20", 900.0},
        {"load_40", 500.0},
        {"load_60", -400.0},
        {"load_80", -100.0},
        {"load_100", 800.0}},
       ControllerKind::none},
      {"command, a supply that gives way, relief valves",
       Signal::sine(3.0, 10.0),
       {{"external_force", 1500.0},
        {"valve_null_leakage", 5e-12},
        {"supply_resistance", 2e10},
        {"supply_capacity", 5e-13},
        {"pump_flow", 7e-5},
        {"accumulator_volume", 5e-6},
        {"accumulator_precharge", 3e6},
        {"accumulator_exponent", 1.3},
        {"relief_pressure", 3.2e6},
        {"relief_conductance", 1e-10}},
       ControllerKind::none},
      {"command, lagging sensors", Signal::sine(3.0, 10.0), lags, ControllerKind::none},
      {"square command, valve at its fastest",
       Signal::square(2.0, 10.0),
       {{"valve_time_constant", 0.01}, {"valve_rate_limit", 150.0}},
       ControllerKind::none},
      {"square command, second-order valve, delayed",
       Signal::square(2.0, 10.0),
       {{"valve_frequency", 500.0}, {"valve_damping_ratio", 0.5}, {"transport_delay", 0.0043}},
       ControllerKind::none},
      {"square command, two-stage valve, delayed",
       Signal::square(2.0, 10.0),
       {{"valve_frequency", 900.0},
        {"valve_damping_ratio", 0.6},
        {"main_spool_gain", 250.0},
        {"valve_rate_limit", 150.0},
        {"transport_delay", 0.0043}},
       ControllerKind::none},
      {"begins at its step, delayed, PID, valve",
       Signal::square(0.004, 8.0),
       {{"initial_position", 1e-3},
        {"position_offset", 3e-4},
        {"transport_delay", 0.0123},
        {"kd", 2.0},
        {"derivative_filter", 200.0},
        {"valve_time_constant", 0.004}},
       ControllerKind::pid,
       InitialState::given,
       false,
       Feedback::position,
       Before::rest},
      {"settled, sampled PI, valve, load",
       Signal::linear({0.0, 0.02, 0.1}, {0.003, 0.003, -0.002}),
       {{"stiffness", 5e4},
        {"ki", 800.0},
        {"sample_time", 0.0025},
        {"external_force", 300.0},
        {"valve_frequency", 700.0},
        {"valve_damping_ratio", 0.7},
        {"transport_delay", 0.0043}},
       ControllerKind::pid,
       InitialState::rest,
       false,
       Feedback::position,
       Before::steady},
      {"settled, open loop in motion",
       Signal::sine(2.0, 10.0),
       {{"initial_position", 1e-3}, {"valve_offset", 0.4}, {"valve_time_constant", 0.004}},
       ControllerKind::none,
       InitialState::given,
       false,
       Feedback::position,
       Before::steady},
  };
  return rows;
}

}  // namespace

TEST_CASE("sensitivity: exact against differences, every parameter, term and waveform", "[model]") {
  std::set<int> seen;
  for (const Scenario& scenario : scenarios()) {
    CAPTURE(scenario.name);
    check_sensitivities(experiment(scenario), seen);
  }
  check_all_seen(PlantKind::load_pressure, seen);
}

TEST_CASE("sensitivity: many at once equal one at a time", "[model]") {
  Experiment e = experiment(scenarios().front());
  e.options.tolerance = 1e-8;
  e.free = fittable(e);
  REQUIRE(e.free.size() > 8);
  const Simulation together = e();
  REQUIRE(together.ok());
  const auto all = e.free;
  for (std::size_t j = 0; j < all.size(); ++j) {
    e.free = {all[j]};
    const Simulation alone = e();
    REQUIRE(alone.ok());
    for (std::size_t k = 0; k < e.outputs.size(); ++k) {
      const Eigen::VectorXd expected = alone.sensitivities[k].col(0);
      CAPTURE(all[j], output_name(e.outputs[k]));
      // The same solution, computed with other steps. The tolerance is 20 times looser than for the
      // states, and errors add up over some hundred steps.
      CHECK(peak(together.sensitivities[k].col(static_cast<Eigen::Index>(j)) - expected) <=
            6e-4 * peak(expected));
    }
  }
}

TEST_CASE("sensitivity: the same by both methods", "[model]") {
  for (std::size_t i = 0; i < scenarios().size(); i += rigcal::test::kSanitized ? 3 : 1) {
    const Scenario& scenario = scenarios()[i];
    Experiment e = experiment(scenario);
    e.outputs = {Output::position, Output::load_pressure};
    e.free = fittable(e);
    const Simulation implicit = e();
    REQUIRE(implicit.ok());
    e.options.method = Method::dopri5;
    const Simulation other = e();
    REQUIRE(other.ok());
    for (std::size_t k = 0; k < e.outputs.size(); ++k) {
      for (Eigen::Index j = 0; j < static_cast<Eigen::Index>(e.free.size()); ++j) {
        const Eigen::VectorXd expected = implicit.sensitivities[k].col(j);
        const auto index = static_cast<std::size_t>(e.free[static_cast<std::size_t>(j)]);
        // Values that are negligible relative to the output itself count as zero.
        const double size = std::max(std::abs(e.values.value[index]), 1e-12);
        const double least = 1e-6 * peak(implicit.outputs.col(static_cast<Eigen::Index>(k))) / size;
        CAPTURE(scenario.name, j, k, peak(expected));
        CHECK(peak(other.sensitivities[k].col(j) - expected) <= 1e-3 * peak(expected) + least);
      }
    }
  }
}

TEST_CASE("sensitivity: exact where the leak is stiff", "[model]") {
  Experiment e;
  e.set("leakage_coefficient", 1.35);
  e.times_s = grid(0.0, 2.5, 51);
  e.inputs.drive = Signal::sine(0.0508, 0.1);
  e.options.tolerance = 1e-9;
  for (const char* key : {"mass", "damping", "valve_gain", "leakage_coefficient", "kp"}) {
    e.free.push_back(parameter_index(PlantKind::load_pressure, key));
  }
  const Simulation run = e();
  REQUIRE(run.ok());
  for (std::size_t j = 0; j < e.free.size(); ++j) {
    // Mass hardly matters here, and the bulk modulus not at all. A long step raises their effects
    // above the noise.
    const Eigen::MatrixXd expected = difference_by(e, e.free[j], 1e-2);
    for (std::size_t k = 0; k < 2; ++k) {
      CAPTURE(e.free[j], k);
      const auto exact = run.sensitivities[k].col(static_cast<Eigen::Index>(j));
      // Allows for truncation of (1e-2)^2, and for noise from an error of 1e-9 per step.
      const double noise = 1e-7 * peak(run.outputs.col(static_cast<Eigen::Index>(k))) /
                           (1e-2 * e.values.value[static_cast<std::size_t>(e.free[j])]);
      CHECK(peak(exact - expected.col(static_cast<Eigen::Index>(k))) < 1e-3 * peak(exact) + noise);
      CHECK(peak(exact) > 5.0 * noise);
    }
  }
}

TEST_CASE("sensitivity: at the tolerance of a fit good to a percent", "[model]") {
  // Step control includes the sensitivities. Otherwise they would be wrong without notice
  // (paper.md).
  Experiment e;
  e.inputs.drive = Signal::square(0.0508, 1.0);
  e.times_s = grid(0.0, 2.0, 201);
  for (const char* key : {"mass", "bulk_modulus", "valve_gain", "leakage_coefficient"}) {
    e.free.push_back(parameter_index(PlantKind::load_pressure, key));
  }
  e.options.tolerance = 1e-4;
  const Simulation loose = e();
  e.options.tolerance = 1e-9;
  const Simulation tight = e();
  REQUIRE(loose.ok());
  REQUIRE(tight.ok());
  for (Eigen::Index j = 0; j < 4; ++j) {
    const Eigen::VectorXd expected = tight.sensitivities[0].col(j);
    CAPTURE(j);
    CHECK(peak(loose.sensitivities[0].col(j) - expected) < 0.02 * peak(expected));
  }
}

TEST_CASE("sensitivity: a lag of zero is known by what a lag would change", "[model]") {
  constexpr double kStep_s = 5e-6;
  constexpr double kLeast_s = 1e-6;  // the valve's state follows with at least that
  // After the edge of a square the pressure crosses zero, where the root of the leak has a kink.
  // There the differences are of first order: 2.2 % at this step, 5.4 % at four times as much.
  constexpr double kOfDifferences = 0.04;
  for (const Signal& drive : {Signal::sine(0.006, 9.0), Signal::square(0.004, 8.0)}) {
    for (const char* key : {"valve_time_constant", "position_lag", "load_pressure_lag"}) {
      Experiment e;
      e.inputs.drive = drive;
      e.times_s = grid(0.00131, 0.12528, 50);  // avoids every edge
      e.times_s.insert(e.times_s.begin(), 0.0);
      e.options.tolerance = 1e-9;
      e.options.method = Method::rosenbrock;
      const auto outputs_at = [&e, key](double lag_s) {
        Experiment there = e;
        const Simulation run = there.set(key, lag_s)();
        REQUIRE(run.ok());
        return run.outputs;
      };
      const Eigen::MatrixXd expected =
          (4.0 * outputs_at(kLeast_s + kStep_s) - 3.0 * outputs_at(kLeast_s) -
           outputs_at(kLeast_s + 2.0 * kStep_s)) /
          (2.0 * kStep_s);
      for (const double lag_s : {0.0, kLeast_s}) {
        Experiment free = e;
        free.set(key, lag_s);
        free.free = {parameter_index(PlantKind::load_pressure, key)};
        const Simulation run = free();
        INFO(run.reason);
        REQUIRE(run.ok());
        CHECK(difference(outputs_at(lag_s), run.outputs) < 1e-6);
        bool has_effect = false;
        for (std::size_t k = 0; k < 2; ++k) {
          const auto column = static_cast<Eigen::Index>(k);
          const Eigen::VectorXd exact = run.sensitivities[k].col(0);
          const double noise = 5e-8 * peak(run.outputs.col(column)) / kStep_s;
          CAPTURE(key, lag_s, k, peak(exact));
          CHECK(peak(exact - expected.col(column)) < kOfDifferences * peak(exact) + noise);
          has_effect = has_effect || peak(exact) > 100.0 * noise;
        }
        CHECK(has_effect);
      }
    }
  }
}

TEST_CASE("sensitivity: a free lag of zero leaves the run as it is without one", "[model]") {
  Experiment e;
  e.inputs.drive = Signal::sine(0.006, 9.0);
  const Simulation plain = e();
  REQUIRE(plain.ok());
  for (const char* key : {"valve_time_constant", "position_lag"}) {
    Experiment at_zero = e;
    at_zero.set(key, 0.0);
    at_zero.free = {parameter_index(PlantKind::load_pressure, key)};
    const Simulation run = at_zero();
    REQUIRE(run.ok());
    CAPTURE(key);
    CHECK(difference(plain.outputs, run.outputs) < 1e-3);  // 1 us of the ringing, at 587 rad/s
  }
}
