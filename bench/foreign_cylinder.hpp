#pragma once

#include <vector>

#include "bench/problems.hpp"

namespace rigcal::bench {

/// A cylinder with two chambers behind a servo valve with four edges. Like ForeignRig, it is an
/// independent implementation of docs/model.md with fixed steps. All values are in SI units; they
/// are those of the Hopsan rig (datasets/rigs/hopsan_leaky_servo), with an ideal valve and dead
/// volumes.
struct ForeignCylinder {
  double mass_kg = 85.0, damping_n_s_per_m = 1000.0;
  double area_m2 = 1.62e-3, stroke_m = 0.1524, dead_volume_m3 = 3e-5;
  double supply_pa = 6.2e6, tank_pa = 0.0, bulk_modulus_pa = 689e6;
  double density_kg_per_m3 = 847.0, discharge = 0.6, gradient_m = 20.75e-3;
  double valve_gain_m_per_v = 4.06e-5, kp_v_per_m = 78.74, limit_v = 10.0;
  double straight_below_pa = 1000.0;
  double leak_coefficient = 0.0, leak_area_m2 = 4.456e-6;  ///< leak through an orifice
  double laminar_m3_per_s_pa = 0.0;                        ///< laminar leak
};

/// Noise-free readings at 1 kHz.
struct CylinderReadings {
  std::vector<double> position_m, pressure_a_pa, pressure_b_pa;
  double leak_m3_per_s = 0.0;  ///< mean |leakage flow|
};

/// Returns the readings from rest in the middle of the stroke.
CylinderReadings foreign_readings(const ForeignCylinder& rig, const Reference& reference);

}  // namespace rigcal::bench
