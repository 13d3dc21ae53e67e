#pragma once

#include "tests/model/rig.hpp"

namespace rigcal::model {

/// The paper's rig with both chambers: its piston, with half of its volume on each side of
/// mid-stroke.
inline Experiment two_chamber_rig() {
  Experiment e;
  e.rig.plant = PlantKind::two_chamber;
  const ParameterValues paper = paper_rig();
  e.values = ParameterValues::defaults(PlantKind::two_chamber);
  const auto table = parameter_table(PlantKind::load_pressure);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const int index = parameter_index(PlantKind::two_chamber, table[i].key);
    if (paper.given[i] && index >= 0) e.values.set(index, paper.value[i]);
  }
  e.set("area_a", 1.62e-3).set("area_b", 1.62e-3).set("stroke", 0.1524).set("tank_pressure", 0.0);
  e.set("dead_volume_a", 0.0).set("dead_volume_b", 0.0);
  return e;
}

/// A single-rod cylinder with the valve open at a constant command.
inline Experiment single_rod_rig() {
  Experiment e = two_chamber_rig();
  e.rig.controller = ControllerKind::none;
  e.set("area_a", 2.0e-4).set("area_b", 1.2e-4).set("stroke", 0.2);
  e.set("dead_volume_a", 2e-5).set("dead_volume_b", 3e-5).set("mass", 5.0).set("damping", 200.0);
  e.set("bulk_modulus", 400e6).set("supply_pressure", 4.4e6).set("tank_pressure", 1e5);
  e.set("valve_gain", 4e-6).set("leakage_coefficient", 0.0);
  e.inputs.drive = Signal::square(2.0, 2.0);
  return e;
}

/// A sliding cylinder of a mobile machine, with a pilot-operated valve and an unlimited pump.
inline Experiment pilot_rig() {
  Experiment e;
  e.rig.plant = PlantKind::two_chamber;
  e.rig.controller = ControllerKind::none;
  e.rig.pilot = true;
  e.values = ParameterValues::defaults(PlantKind::two_chamber);
  e.set("mass", 2000.0).set("damping", 4e4).set("stiffness", 0.0).set("stroke", 1.0);
  e.set("area_a", 4e-3).set("area_b", 2.4e-3).set("dead_volume_a", 1e-3).set("dead_volume_b", 1e-3);
  e.set("tank_pressure", 2e5).set("supply_pressure", 2e7).set("density", 870.0);
  e.set("bulk_modulus", 8e8).set("discharge_coefficient", 0.65).set("area_gradient", 0.02);
  e.set("leakage_coefficient", 0.0).set("leakage_area", 1e-6);
  e.set("pilot_gain", 1e-11).set("pilot_dead_band", 1e6);
  e.inputs.drive = Signal::constant(2e6);
  e.times_s = {0.0, 2.0};
  e.options.tolerance = 1e-9;
  e.outputs = {Output::position, Output::velocity, Output::pressure_a, Output::pressure_b};
  return e;
}

/// pilot_rig() with an electric valve.
inline Experiment proportional_rig() {
  Experiment e = pilot_rig();
  e.rig.pilot = false;
  e.unset("pilot_gain").unset("pilot_dead_band");
  e.set("valve_gain", 2e-6).set("valve_dead_band", 0.5);
  e.inputs.drive = Signal::constant(5.5);
  return e;
}

}  // namespace rigcal::model
