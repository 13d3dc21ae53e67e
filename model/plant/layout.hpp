#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "model/plant/parameter.hpp"
#include "model/plant/rig.hpp"

namespace rigcal::model {

/// Optional terms of a rig's model. An absent term costs no computing time.
struct PresentTerms {
  bool friction = false;         ///< any friction of piston and rod was given
  bool stribeck = false;         ///< breakaway friction was given
  bool seal_friction = false;    ///< friction grows with the pressure across the piston
  bool shaped_friction = false;  ///< friction depends on the pressure, or has pre-sliding
  bool joint_friction = false;   ///< friction of a joint was given
  int bristles = -1;  ///< index of the force of the bristles; -1: friction without pre-sliding
  int film = -1;      ///< index of the thickness of the lubricant film; -1: steady friction
  bool orifice_leak = false;   ///< the leakage coefficient is not zero, or is free
  bool leak_line = false;      ///< the leak is laminar at low pressure: its resistance was given
  bool laminar_leak = false;   ///< the laminar leakage was given
  bool null_leak = false;      ///< the laminar leakage of the valve's closed edges was given
  bool valve_offset = false;   ///< the null shift is not zero, or is free
  bool spool_shape = false;    ///< null shift or overlap is not zero, or is free
  bool external_load = false;  ///< a load is recorded, or the external force is not zero or free
  bool varying_load = false;   ///< the load varies with the travel
  bool curved_load = false;    ///< the curvature of the load is not zero, or is free
  bool load_table = false;     ///< the load is given by a table over the travel
  bool overlaps = false;       ///< the overlap of an edge is not zero, or is free
  bool null_opening = false;   ///< covered edges leak through an orifice
  bool line_loss = false;      ///< the lines also throttle the flow
  bool air = false;            ///< the bulk modulus falls at low pressure
  bool temperature = false;    ///< the oil follows its temperature
  bool external_leak = false;  ///< the external leak of a chamber is not zero, or is free
  int hoses = -1;              ///< index of the first state of yielding hoses; -1: rigid hoses
  int payload = -1;            ///< index of the first state of the second mass; -1: no second mass
  bool pilot = false;          ///< the drive of the spool is a pilot pressure
  bool power_opening = false;  ///< the spool opens according to a power law
  bool return_band = false;    ///< the edges to the tank have their own dead band
  bool return_power = false;   ///< the edges to the tank have their own power law
  bool return_line = false;    ///< the line to the tank also throttles the flow
  bool return_loss = false;  ///< the line to the tank has a pressure loss proportional to its flow
  bool bypass = false;       ///< a closed valve passes the flow of the pump to the tank
  bool table_opening = false;  ///< the spool opens according to a table
  bool compensator = false;    ///< edges from the supply are pressure-compensated
  bool load_sensing = false;   ///< the pump follows the pressure of the driven chamber
  bool accumulator = false;    ///< an accumulator adds to the capacity of the supply
  bool relief = false;         ///< each chamber has a relief valve
  /// The valve has any term besides gains and overlaps of its edges, null opening and line loss.
  bool shaped_valve = false;
  bool pump_flow = false;  ///< the flow of the pump is limited
  bool make_up = false;    ///< the tank fills a chamber whose pressure drops too low
  int pump = -1;           ///< index of the demand time of the pump; -1: its limit is constant
  int supply =
      -1;  ///< index of the supply pressure at the valve; -1: equal to the pressure of the source
  bool valve_rate_limit = false;
  bool retracted_position = false;     ///< was given; otherwise half a stroke below zero
  bool initial_load_pressure = false;  ///< was given; otherwise in equilibrium
  bool initial_pressure_a = false;  ///< was given; otherwise from the other pressure and the load
  bool initial_pressure_b = false;
};

/// Everything that the program knows about a state. Error control, solver and FMU read this row.
/// The derivative of the state is in derivative() of the plant or, if the state does not belong to
/// the plant, in system.hpp.
struct StateRow {
  std::string_view name;     ///< name of the output with the same value, if there is one
  std::string_view unit;     ///< SI
  std::string_view meaning;  ///< one line
  double floor = 0.0;        ///< size below which the error control treats it as zero
  /// Typical size. For a pressure, it is a fraction of the supply pressure. An importer derives its
  /// absolute tolerance from it.
  double nominal = 0.0;
};

// States of the plants.
inline constexpr StateRow kPistonPosition{"position", "m", "position of the piston", 1e-6, 0.01};
inline constexpr StateRow kPistonVelocity{"velocity", "m/s", "velocity of the piston", 1e-5, 0.1};
inline constexpr StateRow kPressureA{"pressure_a", "Pa", "pressure of chamber A", 100.0, 0.1};
inline constexpr StateRow kPressureB{"pressure_b", "Pa", "pressure of chamber B", 100.0, 0.1};

// States that a rig may have in addition to those of its plant.
inline constexpr StateRow kHoseMemoryA{"hose_memory_a", "1",
                                       "strain memory of the hose of chamber A", 1e-3, 1.0};
inline constexpr StateRow kHoseMemoryB{"hose_memory_b", "1",
                                       "strain memory of the hose of chamber B", 1e-3, 1.0};
inline constexpr StateRow kPayloadPosition{"payload_position", "m", "position of the second mass",
                                           1e-6, 0.01};
inline constexpr StateRow kPayloadVelocity{"payload_velocity", "m/s", "velocity of the second mass",
                                           1e-5, 0.1};
inline constexpr StateRow kValveSupply{"valve_supply_pressure", "Pa",
                                       "supply pressure at the valve", 100.0, 0.1};
inline constexpr StateRow kValveSignal{"valve_signal", "V", "signal that the spool has reached",
                                       1e-3, 1.0};
inline constexpr StateRow kValveSignalRate{"valve_signal_rate", "V/s", "its rate", 1.0, 100.0};
inline constexpr StateRow kPilotOpening{
    "pilot_opening", "V", "opening of the pilot stage, in volts of the main spool", 1e-3, 1.0};
inline constexpr StateRow kPilotOpeningRate{"pilot_opening_rate", "V/s", "its rate", 1.0, 100.0};
inline constexpr StateRow kPilotSignal{"valve_signal", "Pa",
                                       "pilot pressure that the spool has reached", 100.0, 0.01};
inline constexpr StateRow kPilotSignalRate{"valve_signal_rate", "Pa/s", "its rate", 1e5, 1e7};
inline constexpr StateRow kPumpDemand{
    "pump_demand", "s", "time for which flow has been demanded from the pump", 1e-3, 1.0};
inline constexpr StateRow kBristleForce{
    "bristle_force", "N", "force of seals and contacts before they slide", 0.1, 100.0};
inline constexpr StateRow kFilmThickness{
    "film_thickness", "1", "lubricant film of the seals, relative to the thickest", 1e-3, 1.0};
inline constexpr StateRow kIntegral{"controller_integral", "V", "integral action", 1e-3, 1.0};
inline constexpr StateRow kFilteredReference{"controller_filtered_reference", "m",
                                             "filtered reference", 1e-6, 0.01};
inline constexpr StateRow kFilteredRate{"controller_filtered_rate", "m/s",
                                        "filtered rate of the reference", 1e-5, 0.1};
inline constexpr StateRow kFilteredAngleReference{"controller_filtered_reference", "rad",
                                                  "filtered reference", 1e-6, 0.1};
inline constexpr StateRow kFilteredAngularRate{"controller_filtered_rate", "rad/s",
                                               "filtered rate of the reference", 1e-5, 0.1};
inline constexpr StateRow kHeldOutput{"controller_held_output", "V",
                                      "output of the sampled controller", 1e-3, 1.0};
/// Filtered error, in the unit of the controlled quantity. Three-variable control has none.
inline constexpr std::array<StateRow, 6> kFilteredError{
    StateRow{"controller_filtered_error", "m", "filtered error", 1e-6, 0.01},
    StateRow{"controller_filtered_error", "N", "filtered error", 0.1, 1e3},
    StateRow{"controller_filtered_error", "Pa", "filtered error", 100.0, 0.1},
    StateRow{"controller_filtered_error", "m/s2", "filtered error", 1e-3, 1.0},
    StateRow{"controller_filtered_error", "rad", "filtered error", 1e-6, 0.1},
    StateRow{"controller_filtered_error", "N m", "filtered error", 0.1, 1e3}};

/// The states that a rig has in addition to those of its plant, with their indices in the state
/// vector.
struct Layout {
  int plant_states = 0;
  int hoses = -1;       ///< strain memory of both hoses [1]
  int supply = -1;      ///< supply pressure at the valve [Pa]
  int pump = -1;        ///< demand time: how long the valve has demanded flow from the pump [s]
  int payload = -1;     ///< position [m] and velocity [m/s] of the second mass
  int bristles = -1;    ///< force of the bristles [N]
  int film = -1;        ///< thickness of the lubricant film [1]
  int valve_order = 0;  ///< 0: the spool follows the command; 1, 2: order of its lag
  int valve = -1;       ///< first valve state: spool signal [V], then its rate [V/s]
  /// The valve has two stages: its first state is the main spool, and the lag of `valve_order` that
  /// follows is the pilot stage's.
  bool main_spool = false;
  bool pid = false;
  Feedback feedback = Feedback::position;  ///< quantity that the loop controls
  bool pressure_feedback = false;          ///< the load pressure is fed back inside the loop
  int integral = -1;                       ///< integral action [V]
  int filter = -1;                         ///< filtered error, in the unit of `feedback`
  int reference = -1;      ///< filtered reference of a feed-forward or of a generator [m, or rad]
  int rate = -1;           ///< its rate, filtered once more for a feed-forward [m/s, or rad/s]
  bool generator = false;  ///< three-variable control: both states are those of its generator
  int held = -1;           ///< output of a sampled controller, constant between ticks [V]
  PresentTerms terms;
  int states = 0;

  static constexpr std::size_t kMostAdded = 12;
  std::array<const StateRow*, kMostAdded> added{};  ///< the states after those of the plant

  bool sampled() const { return held >= 0; }
  /// Whether the loop feeds back only the motion, position or angle, and has no feed-forward.
  bool motion_alone() const {
    return (feedback == Feedback::position || feedback == Feedback::angle) && !pressure_feedback &&
           reference < 0;
  }
  /// Whether a state changes at the tick of a sampled controller.
  bool of_controller(int state) const {
    return state >= 0 && (state == integral || state == filter || state == reference ||
                          state == rate || state == held);
  }

  /// Adds a state to the layout.
  ///
  /// @return  index of the state
  int add(const StateRow& row) {
    added.at(static_cast<std::size_t>(states - plant_states)) = &row;
    return states++;
  }
};

/// Size below which the error control treats each state as zero; 1 for unused states.
template <typename Plant, std::size_t N>
std::array<double, N> state_floors(const Layout& layout) {
  std::array<double, N> floor;
  floor.fill(1.0);
  const auto plant = static_cast<std::size_t>(Plant::kStates);
  for (std::size_t i = 0; i < plant; ++i) floor[i] = Plant::kStateRows[i].floor;
  for (std::size_t i = plant; i < static_cast<std::size_t>(layout.states); ++i)
    floor[i] = layout.added.at(i - plant)->floor;
  return floor;
}

/// @param free  table indices of the parameters whose sensitivities are requested
inline Layout layout_of(const Rig& rig, const ParameterValues& values, std::span<const int> free,
                        int plant_states, bool load_recorded = false) {
  Layout layout;
  layout.plant_states = plant_states;
  layout.states = plant_states;
  const auto given = [&values](std::string_view key) { return values.is_given(key); };
  // The table of this plant lacks terms that only other plants have.
  const auto acts = [&](std::string_view key) {
    const int index = parameter_index(values.plant, key);
    return index >= 0 &&
           (values[key] != 0.0 || std::find(free.begin(), free.end(), index) != free.end());
  };
  if (given("hose_yield") || given("hose_yield_ratio")) {
    layout.hoses = layout.add(kHoseMemoryA);
    layout.add(kHoseMemoryB);
  }
  if (given("supply_capacity")) layout.supply = layout.add(kValveSupply);
  if (given("pump_second_flow")) layout.pump = layout.add(kPumpDemand);
  if (given("payload_mass")) {
    layout.payload = layout.add(kPayloadPosition);
    layout.add(kPayloadVelocity);
  }
  if (given("bristle_stiffness")) layout.bristles = layout.add(kBristleForce);
  if (given("film_velocity")) layout.film = layout.add(kFilmThickness);
  layout.terms.pilot = given("pilot_gain");
  if (given("valve_frequency")) {
    layout.valve_order = 2;
  } else if (given("valve_time_constant")) {
    layout.valve_order = 1;
  }
  if (layout.valve_order > 0) {
    layout.main_spool = given("main_spool_gain");
    layout.valve = layout.add(layout.terms.pilot ? kPilotSignal : kValveSignal);
    if (layout.main_spool) layout.add(kPilotOpening);
    if (layout.valve_order == 2)
      layout.add(layout.main_spool    ? kPilotOpeningRate
                 : layout.terms.pilot ? kPilotSignalRate
                                      : kValveSignalRate);
  }
  layout.pid = rig.controller == ControllerKind::pid;
  if (layout.pid) {
    layout.feedback = rig.feedback;
    layout.pressure_feedback = acts("pressure_feedback");
    const FeedbackRow& loop = gain_keys(rig.feedback);
    const bool turns = rig.feedback == Feedback::angle;
    const auto forward = [&](std::string_view key) { return !key.empty() && given(key); };
    if (given(loop.ki)) layout.integral = layout.add(kIntegral);
    layout.generator = is_three_variable(rig.feedback);
    if (given(loop.kd) && !layout.generator)
      layout.filter = layout.add(kFilteredError.at(static_cast<std::size_t>(rig.feedback)));
    const bool accelerates = layout.generator || forward(loop.acceleration_feedforward);
    if (accelerates || forward(loop.velocity_feedforward))
      layout.reference = layout.add(turns ? kFilteredAngleReference : kFilteredReference);
    if (accelerates) layout.rate = layout.add(turns ? kFilteredAngularRate : kFilteredRate);
    if (given("sample_time")) layout.held = layout.add(kHeldOutput);
  }
  layout.terms.stribeck = given("stribeck_friction");
  layout.terms.seal_friction = given("seal_friction");
  layout.terms.shaped_friction =
      layout.terms.seal_friction || layout.bristles >= 0 || layout.film >= 0;
  layout.terms.friction =
      layout.terms.shaped_friction || layout.terms.stribeck || given("coulomb_friction");
  layout.terms.joint_friction = given("joint_friction");
  layout.terms.orifice_leak = acts("leakage_coefficient");
  layout.terms.leak_line = given("leakage_resistance");
  layout.terms.laminar_leak = acts("laminar_leakage");
  layout.terms.null_leak = acts("valve_null_leakage");
  layout.terms.external_load = load_recorded || acts("external_force");
  layout.terms.curved_load = acts("load_curvature");
  layout.terms.load_table = given("load_table_to");
  layout.terms.varying_load =
      layout.terms.load_table || layout.terms.curved_load || acts("load_gradient");
  layout.terms.valve_offset = acts("valve_offset");
  layout.terms.spool_shape = layout.terms.valve_offset || acts("valve_dead_band");
  layout.terms.external_leak = acts("external_leakage_a") || acts("external_leakage_b");
  layout.terms.overlaps = acts("overlap_supply_to_a") || acts("overlap_a_to_tank") ||
                          acts("overlap_supply_to_b") || acts("overlap_b_to_tank");
  layout.terms.null_opening = given("valve_null_opening");
  layout.terms.line_loss = given("valve_line_opening");
  layout.terms.air = given("air_fraction");
  layout.terms.temperature = given("reference_temperature");
  layout.terms.power_opening = given("pilot_exponent") || given("valve_exponent");
  layout.terms.table_opening =
      given("opening_20") || given("opening_40") || given("opening_60") || given("opening_80");
  layout.terms.compensator = given("compensator_pressure");
  layout.terms.return_band = given("return_dead_band");
  layout.terms.return_power = given("return_exponent");
  layout.terms.return_line = given("return_line_opening");
  layout.terms.return_loss = acts("return_line_resistance");
  layout.terms.bypass = given("bypass_opening");
  layout.terms.pump_flow = given("pump_flow");
  layout.terms.make_up = acts("make_up_conductance");
  layout.terms.relief = given("relief_pressure");
  layout.terms.load_sensing = given("load_sensing_margin");
  layout.terms.accumulator = given("accumulator_volume");
  layout.terms.shaped_valve = layout.terms.pilot || layout.terms.power_opening ||
                              layout.terms.table_opening || layout.terms.compensator ||
                              layout.terms.return_power || layout.terms.return_line ||
                              layout.terms.return_loss;
  layout.terms.pump = layout.pump;
  layout.terms.supply = layout.supply;
  layout.terms.hoses = layout.hoses;
  layout.terms.payload = layout.payload;
  layout.terms.bristles = layout.bristles;
  layout.terms.film = layout.film;
  layout.terms.valve_rate_limit = given("valve_rate_limit");
  layout.terms.retracted_position = given("retracted_position");
  layout.terms.initial_load_pressure = given("initial_load_pressure");
  layout.terms.initial_pressure_a = given("initial_pressure_a");
  layout.terms.initial_pressure_b = given("initial_pressure_b");
  return layout;
}

}  // namespace rigcal::model
