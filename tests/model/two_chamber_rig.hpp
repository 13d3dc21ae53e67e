#pragma once

#include "tests/model/rig.hpp"

namespace rigcal::model {

/// The paper's rig with both chambers: its piston, half of its volume to each side of mid-stroke.
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

/// A single-rod cylinder on an open valve command.
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

}  // namespace rigcal::model
