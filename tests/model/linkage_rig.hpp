#pragma once

#include "tests/model/two_chamber_rig.hpp"

namespace rigcal::model {

/// The weightless arm of a small excavator, with a pilot-operated valve, an unlimited pump, and
/// stops at -1 and 1 rad.
inline Experiment arm_rig() {
  Experiment e;
  e.rig.plant = PlantKind::linkage;
  e.rig.controller = ControllerKind::none;
  e.rig.pilot = true;
  e.values = ParameterValues::defaults(PlantKind::linkage);
  e.set("inertia", 400.0).set("joint_damping", 500.0);
  e.set("lever", 0.3).set("lower_stop", -1.0).set("upper_stop", 1.0).set("stop_stiffness", 1e7);
  e.set("area_a", 4e-3).set("area_b", 2.4e-3).set("dead_volume_a", 1e-3).set("dead_volume_b", 1e-3);
  e.set("tank_pressure", 2e5).set("supply_pressure", 2e7).set("density", 870.0);
  e.set("bulk_modulus", 8e8).set("discharge_coefficient", 0.65).set("area_gradient", 0.02);
  e.set("leakage_coefficient", 0.0).set("leakage_area", 1e-6);
  e.set("pilot_gain", 5e-10).set("pilot_dead_band", 1e6);
  e.inputs.drive = Signal::constant(1.5e6);
  e.outputs = {Output::angle, Output::angular_velocity};
  return e;
}

}  // namespace rigcal::model
