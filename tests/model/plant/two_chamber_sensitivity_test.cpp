#include "tests/model/sensitivity.hpp"
#include "tests/model/two_chamber_rig.hpp"

using namespace rigcal::model;

namespace {

/// Every combination of terms that changes the layout, with every parameter of the plant at least
/// once.
std::vector<std::pair<Scenario, Experiment>> two_chamber_scenarios() {
  const NamedValues edges{
      {"gain_supply_to_a", 1.1},    {"gain_a_to_tank", 0.9},      {"gain_supply_to_b", 0.8},
      {"gain_b_to_tank", 1.2},      {"overlap_supply_to_a", 0.2}, {"overlap_a_to_tank", -0.1},
      {"overlap_supply_to_b", 0.1}, {"overlap_b_to_tank", -0.2},  {"valve_offset", 0.15},
      {"valve_dead_band", 0.25},    {"valve_null_opening", 0.1},  {"valve_null_leakage", 2e-13},
      {"valve_line_opening", 3.0},  {"laminar_leakage", 3e-13},   {"external_leakage_a", 2e-13},
      {"external_leakage_b", 3e-13}};
  const NamedValues given{{"initial_position", 0.01},
                          {"initial_velocity", 0.02},
                          {"initial_pressure_a", 1.5e6},
                          {"initial_pressure_b", 2.5e6},
                          {"position_offset", 1e-3},
                          {"pressure_a_offset", 2e4},
                          {"pressure_b_offset", -3e4},
                          {"load_pressure_offset", 1e5},
                          {"force_offset", 20.0},
                          {"position_gain", 1.05},
                          {"pressure_a_gain", 1.02},
                          {"pressure_b_gain", 0.95},
                          {"load_pressure_gain", 0.97},
                          {"force_gain", 1.1},
                          {"position_lag", 4e-3},
                          {"pressure_a_lag", 2e-3},
                          {"pressure_b_lag", 5e-3},
                          {"load_pressure_lag", 3e-3},
                          {"force_lag", 6e-3},
                          {"acceleration_gain", 1.05},
                          {"acceleration_offset", 5.0},
                          {"acceleration_lag", 4e-3},
                          {"payload_acceleration_gain", 0.9},
                          {"payload_acceleration_offset", -5.0},
                          {"payload_acceleration_lag", 5e-3},
                          {"payload_mass", 3.0},
                          {"payload_frequency", 150.0},
                          {"payload_damping_ratio", 0.2},
                          {"load_gradient", -2e3},
                          {"load_curvature", 2e5},
                          {"gravity", 3.0},
                          {"stiffness", 5e3},
                          {"external_force", 50.0},
                          {"leakage_coefficient", 0.02},
                          {"leakage_resistance", 5e11},
                          {"valve_time_constant", 3e-3},
                          {"air_fraction", 0.01},
                          {"air_exponent", 1.3}};
  const NamedValues hoses{{"hose_capacity_a", 3e-13},
                          {"hose_capacity_b", 2e-13},
                          {"hose_yield", 2e5},
                          {"hose_yield_ratio", 0.2}};
  const NamedValues piloted{{"pilot_gain", 5e-10},
                            {"pilot_exponent", 1.6},
                            {"pilot_range", 1.5e6},
                            {"gain_b_to_tank", 0.7},
                            {"return_dead_band", 0.8e6},
                            {"return_exponent", 1.3},
                            {"return_line_opening", 3e-4},
                            {"return_line_resistance", 2e9},
                            {"bypass_opening", 5e-5},
                            {"bypass_range", 1.2e6},
                            {"supply_resistance", 2e9},
                            {"supply_capacity", 5e-12},
                            {"pump_flow", 5e-4},
                            {"pump_second_flow", 8e-4},
                            {"pump_delay", 0.05},
                            {"pump_rise", 0.02},
                            {"pump_first_rate", 3e-3},
                            {"accumulator_volume", 2e-5},
                            {"accumulator_precharge", 8e6},
                            {"accumulator_exponent", 1.3},
                            {"coulomb_friction", 2e3},
                            {"stribeck_friction", 800.0},
                            {"stribeck_velocity", 0.02},
                            {"seal_friction", 1e-4},
                            {"bristle_stiffness", 2e7},
                            {"bristle_damping", 2e4}};
  const NamedValues lubricated{{"coulomb_friction", 20.0}, {"stribeck_friction", 80.0},
                               {"stribeck_velocity", 0.1}, {"bristle_stiffness", 4e5},
                               {"bristle_damping", 400.0}, {"friction_smoothing", 0.012},
                               {"film_velocity", 0.04},    {"film_growth_time", 0.01},
                               {"film_decay_time", 0.02},  {"film_dwell_time", 0.02}};
  const NamedValues by_table{
      {"valve_range", 8.0},       {"opening_20", 0.1},        {"opening_40", 0.25},
      {"opening_60", 0.5},        {"opening_80", 0.75},       {"valve_gain", 3e-5},
      {"supply_resistance", 1e9}, {"supply_capacity", 2e-12}, {"load_sensing_margin", 3e6}};
  const NamedValues pushed{{"valve_exponent", 1.5},       {"compensator_pressure", 8e5},
                           {"valve_gain", 2e-5},          {"valve_range", 8.0},
                           {"relief_pressure", 8e6},      {"relief_conductance", 3e-10},
                           {"make_up_conductance", 1e-9}, {"external_force", 8e4}};
  const NamedValues loop{{"kp", 900.0},
                         {"ki", 3000.0},
                         {"kd", 2.0},
                         {"derivative_filter", 300.0},
                         {"output_limit", 3.0},
                         {"velocity_feedforward", 5.0},
                         {"acceleration_feedforward", 0.1},
                         {"valve_frequency", 700.0},
                         {"valve_damping_ratio", 0.9},
                         {"supply_resistance", 2e10},
                         {"supply_capacity", 5e-12},
                         {"transport_delay", 3e-3},
                         {"coulomb_friction", 60.0},
                         {"stribeck_friction", 40.0},
                         {"stribeck_velocity", 0.05},
                         {"friction_smoothing", 0.05}};
  NamedValues stop{{"retracted_position", -0.004}, {"stop_stiffness", 2e6},
                   {"stop_damping", 20.0},         {"valve_time_constant", 5e-3},
                   {"valve_rate_limit", 300.0},    {"main_spool_gain", 250.0}};
  std::vector<std::pair<Scenario, Experiment>> rows;
  const auto none = ControllerKind::none;
  rows.push_back(
      {{"four different edges that leak", Signal::sine(2.0, 10.0), edges, none}, single_rod_rig()});
  rows.push_back({{"given state, sensors, aerated oil", Signal::sine(2.0, 10.0), given, none,
                   InitialState::given},
                  single_rod_rig()});
  rows.push_back({{"hoses that yield", Signal::sine(2.0, 10.0), hoses, none}, single_rod_rig()});
  rows.push_back({{"recorded loads", Signal::sine(2.0, 10.0), {}, none, InitialState::rest, true},
                  single_rod_rig()});
  rows.push_back(
      {{"PID, second-order valve, soft supply, friction", Signal::sine(0.006, 9.0), loop},
       single_rod_rig()});
  const NamedValues warm{{"reference_temperature", 313.15}, {"oil_temperature", 338.15},
                         {"viscosity_decay", 0.03},         {"thermal_expansion", 7e-4},
                         {"bulk_modulus_decay", 5.5e-3},    {"laminar_leakage", 3e-12}};
  rows.push_back({{"warm oil", Signal::sine(2.0, 10.0), warm, none}, single_rod_rig()});
  const NamedValues table{{"load_table_from", 0.0}, {"load_table_to", 4e-3}, {"load_0", 40.0},
                          {"load_20", 150.0},       {"load_40", 60.0},       {"load_60", -90.0},
                          {"load_80", -20.0},       {"load_100", 120.0}};
  rows.push_back({{"load by a table", Signal::square(3.0, 4.0), table, none}, single_rod_rig()});
  rows.push_back({{"into the stop", Signal::square(-3.0, 4.0), stop, none}, single_rod_rig()});
  const NamedValues filter{{"derivative_filter", 300.0}, {"initial_position", 0.01}};
  const auto loop_on = [&](Feedback feedback, const Signal& drive, double kp, double ki,
                           double kd) {
    const FeedbackRow& keys = gain_keys(feedback);
    Scenario scenario{keys.name.data(), drive, filter, ControllerKind::pid, InitialState::given};
    scenario.feedback = feedback;
    for (const auto& [key, value] : {std::pair{keys.kp, kp}, {keys.ki, ki}, {keys.kd, kd}})
      scenario.values.emplace_back(key.data(), value);
    scenario.values.emplace_back("pressure_feedback", 2e-7);
    scenario.values.emplace_back("initial_integral", 0.2);
    rows.push_back({scenario, single_rod_rig()});
  };
  loop_on(Feedback::force, Signal::sine(150.0, 9.0), 1e-3, 2e-2, 4e-7);
  loop_on(Feedback::load_pressure, Signal::sine(6e5, 9.0), 2e-7, 4e-6, 8e-11);
  loop_on(Feedback::acceleration, Signal::sine(10.0, 9.0), 2e-3, 4e-2, 8e-6);
  const NamedValues three_variable{{"kp", 300.0},
                                   {"ki", 400.0},
                                   {"velocity_kp", 4.0},
                                   {"acceleration_kp", 1e-3},
                                   {"reference_frequency", 15.0},
                                   {"reference_damping_ratio", 0.7},
                                   {"velocity_feedforward", 5.0},
                                   {"valve_time_constant", 2e-3}};
  Scenario shaken{"three-variable control of an acceleration", Signal::sine(10.0, 9.0),
                  three_variable};
  shaken.feedback = Feedback::three_variable_acceleration;
  rows.push_back({shaken, single_rod_rig()});
  rows.push_back({{"pilot, pump of two flows, accumulator, friction with pre-sliding",
                   Signal::sine(3e6, 8.0), piloted, none},
                  pilot_rig()});
  rows.push_back(
      {{"friction that follows the lubricant film", Signal::sine(1.0, 9.0), lubricated, none},
       single_rod_rig()});
  rows.push_back(
      {{"table, load sensing", Signal::sine(9.0, 8.0), by_table, none}, proportional_rig()});
  rows.push_back(
      {{"pushed in against its valves", Signal::sine(4.0, 8.0), pushed, none}, proportional_rig()});
  // Runs into the other end stop, half a stroke from the middle.
  rows.push_back({{"short stroke",
                   Signal::square(3.0, 4.0),
                   {{"stroke", 0.008}, {"stop_stiffness", 2e6}},
                   none},
                  single_rod_rig()});
  return rows;
}

}  // namespace

TEST_CASE("two_chamber: sensitivities are exact against differences, every parameter and term",
          "[model]") {
  std::set<int> seen;
  for (const auto& [scenario, rig] : two_chamber_scenarios()) {
    CAPTURE(scenario.name);
    Experiment e = experiment(scenario, rig);
    if (scenario.recorded_loads) {
      e.inputs.supply_pressure_pa = Signal::ripple(4.4e6, 2e5, 20.0, 0.4);
      e.inputs.tank_pressure_pa = Signal::linear({0.0, 0.05, 0.1}, {1e5, 2e5, 1.5e5});
    }
    const double supply_pa = e.values["supply_pressure"];
    check_sensitivities(
        e, seen,
        {{Output::load_pressure, supply_pa}, {Output::force, e.values["area_a"] * supply_pa}});
  }
  check_all_seen(PlantKind::two_chamber, seen);
}
