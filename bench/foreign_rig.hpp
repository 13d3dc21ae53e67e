#pragma once

#include <string>
#include <vector>

#include "bench/problems.hpp"

/// A rig whose records are made without the product: docs/model.md written down once more, with a
/// fixed step of the classical Runge-Kutta method, and with small effects that the fitted model
/// lacks. What both get wrong in the same way a study of coverage cannot see.
namespace rigcal::bench {

/// SI throughout. An effect of zero is none.
struct ForeignRig {
  double mass_kg = 110.0, damping_n_s_per_m = 1400.0;
  double area_m2 = 1.62e-3, volume_m3 = 2.46888e-4, supply_pa = 6.2e6, bulk_modulus_pa = 800e6;
  double density_kg_per_m3 = 847.0, discharge = 0.6, gradient_m = 20.75e-3;
  double valve_gain_m_per_v = 4.5e-5;
  double leak_coefficient = 0.35, leak_area_m2 = 4.456e-6, straight_below_pa = 100.0;
  double kp_v_per_m = 120.0, kd_v_s_per_m = 0.3, filter_rad_per_s = 150.0, limit_v = 10.0;

  double valve_lag_s = 0.0, delay_s = 0.0, null_shift_v = 0.0, dead_band_v = 0.0;
  double kp_error_v_per_m = 0.0, kd_error_v_s_per_m = 0.0;  ///< added to what the user knows
  double friction_n = 0.0, laminar_m3_per_s_pa = 0.0, integral_v_per_m_s = 0.0;
  double hose_volume_m3 = 0.0, sag = 0.0;  ///< fraction of the supply at the flow of full command
  double sensor_lag_s = 0.0, sensor_gain = 0.0, sensor_offset_m = 0.0;  ///< gain: relative error
  double sensor_bow_m = 0.0, sensor_wave_m = 0.0, sensor_hysteresis_m = 0.0;
};

/// Readings of the position sensor at a sampling rate of 1 kHz, without noise, from rest.
std::vector<double> foreign_readings(const ForeignRig& rig, const Reference& reference);

}  // namespace rigcal::bench
