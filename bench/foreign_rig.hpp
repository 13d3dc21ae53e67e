#pragma once

#include <string>
#include <vector>

#include "bench/problems.hpp"

/// A rig whose records are generated without the product: an independent implementation of
/// docs/model.md with fixed steps of the classical Runge-Kutta method, and with small effects that
/// the fitted model lacks. A study of coverage cannot detect errors that both implementations have
/// in common.
namespace rigcal::bench {

/// In SI units. An effect of size zero is absent.
struct ForeignRig {
  double mass_kg = 110.0, damping_n_s_per_m = 1400.0;
  double area_m2 = 1.62e-3, volume_m3 = 2.46888e-4, supply_pa = 6.2e6, bulk_modulus_pa = 800e6;
  double density_kg_per_m3 = 847.0, discharge = 0.6, gradient_m = 20.75e-3;
  double valve_gain_m_per_v = 4.5e-5;
  double leak_coefficient = 0.35, leak_area_m2 = 4.456e-6, straight_below_pa = 100.0;
  double kp_v_per_m = 120.0, kd_v_s_per_m = 0.3, filter_rad_per_s = 150.0, limit_v = 10.0;

  double valve_lag_s = 0.0, delay_s = 0.0, null_shift_v = 0.0, dead_band_v = 0.0;
  double kp_error_v_per_m = 0.0,
         kd_error_v_s_per_m = 0.0;  ///< added to the values that the user knows
  double friction_n = 0.0, laminar_m3_per_s_pa = 0.0, integral_v_per_m_s = 0.0;
  double hose_volume_m3 = 0.0,
         sag = 0.0;  ///< sag: fraction of the supply pressure lost at the flow of full command
  double sensor_lag_s = 0.0, sensor_gain = 0.0, sensor_offset_m = 0.0;  ///< gain: relative error
  double sensor_bow_m = 0.0, sensor_wave_m = 0.0, sensor_hysteresis_m = 0.0;
  double valve_play_v = 0.0;  ///< half width; the spool moves only after the signal has taken it up
  double breakaway_n = 0.0;   ///< friction above Coulomb's at rest; decays over 10 mm/s
  double controller_tick_s = 0.0;  ///< a multiple of 10 us; 0: continuous

  // Effects that are not in the product's catalogue.
  double valve_corner_hz = 0.0;       ///< second order, damping 0.7, replaces the lag; 0: none
  double pressure_friction_m2 = 0.0;  ///< seal friction per load pressure
  double square_damping = 0.0;        ///< force per square of the speed [N s2/m2]
  double valve_skew = 0.0;            ///< the valve passes 1 + this outwards, 1 - this inwards
  double oil_drift = 0.0;             ///< relative change of the bulk modulus over a record
  double supply_drift = 0.0;          ///< relative fall of the supply pressure over a record
  double volume_bow =
      0.0;  ///< relative decrease of the oil volume towards either end of the stroke
  double reference_lag_s = 0.0;  ///< a filter ahead of the controller
  double quantum_m = 0.0;        ///< step of the converter; the noise includes its quantisation
};

/// Readings of the position sensor at a sampling rate of 1 kHz, without noise, starting at rest.
std::vector<double> foreign_readings(const ForeignRig& rig, const Reference& reference);

}  // namespace rigcal::bench
