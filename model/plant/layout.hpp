#pragma once

#include <algorithm>
#include <span>
#include <string_view>

#include "model/plant/parameter.hpp"
#include "model/simulate.hpp"

namespace rigcal::model {

/// Optional terms that take part; an absent one costs nothing.
struct PresentTerms {
  bool friction = false;        ///< Coulomb or breakaway friction was given
  bool stribeck = false;        ///< breakaway friction was given
  bool orifice_leak = false;    ///< the leakage coefficient is not zero, or free
  bool laminar_leak = false;    ///< likewise
  bool null_leak = false;       ///< likewise, across the null of the valve
  bool valve_offset = false;    ///< null shift: not zero, or free
  bool spool_shape = false;     ///< null shift or overlap: not zero, or free
  bool external_force = false;  ///< recorded, or not zero, or free
  bool null_opening = false;    ///< covered edges leak through an orifice
  bool line_loss = false;       ///< the lines throttle too
  bool air = false;             ///< the bulk modulus falls at low pressure
  bool external_leak = false;   ///< of either chamber: not zero, or free
  int hoses = -1;               ///< where the states of hoses that yield begin; -1: rigid ones
  bool valve_rate_limit = false;
  bool retracted_position = false;     ///< else half a stroke below zero
  bool initial_load_pressure = false;  ///< else the load pressure starts in equilibrium
  bool initial_pressure_a = false;     ///< else from the other and the load
  bool initial_pressure_b = false;
};

/// Which states a rig has beside those of its plant, and where they stand in the state vector.
struct Layout {
  int plant_states = 0;
  int hoses = -1;       ///< strain memory of both hoses [1]
  int supply = -1;      ///< supply pressure at the valve [Pa]
  int valve_order = 0;  ///< 0: spool follows the command; 1, 2: lag
  int valve = -1;       ///< first valve state: spool signal [V], then its rate [V/s]
  bool pid = false;
  int integral = -1;  ///< integral action [V]
  int filter = -1;    ///< filtered error [m]
  int held = -1;      ///< output of a sampled controller, held [V]
  PresentTerms terms;
  int states = 0;

  bool sampled() const { return held >= 0; }
};

/// @param free  table indices of the parameters whose sensitivities are wanted
inline Layout layout_of(const Rig& rig, const ParameterValues& values, std::span<const int> free,
                        int plant_states, bool force_recorded = false) {
  Layout layout;
  layout.plant_states = plant_states;
  int next = plant_states;
  // Terms of another plant are not in the table of this one.
  const auto given = [&values](std::string_view key) {
    return parameter_index(values.plant, key) >= 0 && values.is_given(key);
  };
  if (given("hose_yield") || given("hose_yield_ratio")) {
    layout.hoses = next;
    next += 2;
  }
  if (given("supply_capacity")) layout.supply = next++;
  if (given("valve_frequency")) {
    layout.valve_order = 2;
  } else if (given("valve_time_constant")) {
    layout.valve_order = 1;
  }
  if (layout.valve_order > 0) layout.valve = next;
  next += layout.valve_order;
  layout.pid = rig.controller == ControllerKind::pid;
  if (layout.pid) {
    if (given("ki")) layout.integral = next++;
    if (given("kd")) layout.filter = next++;
    if (given("sample_time")) layout.held = next++;
  }
  layout.terms.stribeck = given("stribeck_friction");
  layout.terms.friction = layout.terms.stribeck || given("coulomb_friction");
  const auto acts = [&](std::string_view key) {
    const int index = parameter_index(values.plant, key);
    return index >= 0 &&
           (values[key] != 0.0 || std::find(free.begin(), free.end(), index) != free.end());
  };
  layout.terms.orifice_leak = acts("leakage_coefficient");
  layout.terms.laminar_leak = acts("laminar_leakage");
  layout.terms.null_leak = acts("valve_null_leakage");
  layout.terms.external_force = force_recorded || acts("external_force");
  layout.terms.valve_offset = acts("valve_offset");
  layout.terms.spool_shape = layout.terms.valve_offset || acts("valve_dead_band");
  layout.terms.external_leak = acts("external_leakage_a") || acts("external_leakage_b");
  layout.terms.null_opening = given("valve_null_opening");
  layout.terms.line_loss = given("valve_line_opening");
  layout.terms.air = given("air_fraction");
  layout.terms.hoses = layout.hoses;
  layout.terms.valve_rate_limit = given("valve_rate_limit");
  layout.terms.retracted_position = given("retracted_position");
  layout.terms.initial_load_pressure = given("initial_load_pressure");
  layout.terms.initial_pressure_a = given("initial_pressure_a");
  layout.terms.initial_pressure_b = given("initial_pressure_b");
  layout.states = next;
  return layout;
}

}  // namespace rigcal::model
