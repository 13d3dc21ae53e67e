#pragma once

#include <string>
#include <vector>

#include "bench/problems.hpp"

/// A rig whose records are generated without the product. This is an independent implementation of
/// docs/model.md that uses fixed steps of the classical Runge-Kutta method, and includes small
/// effects that the fitted model lacks. A coverage study still cannot detect errors that both
/// implementations share.
namespace rigcal::bench {

/// All values are in SI units. An effect whose size is zero is absent.
struct ForeignRig {
  double mass_kg = 110.0, damping_n_s_per_m = 1400.0;
  double area_m2 = 1.62e-3, volume_m3 = 2.46888e-4, supply_pa = 6.2e6, bulk_modulus_pa = 800e6;
  double density_kg_per_m3 = 847.0, discharge = 0.6, gradient_m = 20.75e-3;
  double valve_gain_m_per_v = 4.5e-5;
  double leak_coefficient = 0.35, leak_area_m2 = 4.456e-6, straight_below_pa = 100.0;
  double kp_v_per_m = 120.0, kd_v_s_per_m = 0.3, filter_rad_per_s = 150.0, limit_v = 10.0;

  double valve_lag_s = 0.0, delay_s = 0.0, null_shift_v = 0.0, dead_band_v = 0.0;
  double kp_error_v_per_m = 0.0,
         kd_error_v_s_per_m = 0.0;  ///< errors in the gains that the user knows
  double friction_n = 0.0, laminar_m3_per_s_pa = 0.0, integral_v_per_m_s = 0.0;
  double hose_volume_m3 = 0.0,
         sag = 0.0;  ///< sag: fraction of the supply pressure lost at full flow
  double sensor_lag_s = 0.0, sensor_gain = 0.0, sensor_offset_m = 0.0;  ///< gain: relative error
  double loop_gain = 0.0;  ///< relative error of the sensor's gain; the controller sees it, too
  double sensor_bow_m = 0.0, sensor_wave_m = 0.0, sensor_hysteresis_m = 0.0;
  double valve_play_v = 0.0;  ///< half-width; the spool moves only after the play has been taken up
  /// Friction at rest in addition to Coulomb friction; decays over 10 mm/s.
  double breakaway_n = 0.0;
  double controller_tick_s = 0.0;  ///< a multiple of 10 us; 0 if the controller is continuous

  // Effects that are not in the product's catalogue.
  /// Second-order valve with damping 0.7 instead of the lag; 0: none.
  double valve_corner_hz = 0.0;
  double pressure_friction_m2 = 0.0;  ///< seal friction per unit of load pressure
  double square_damping = 0.0;        ///< force per squared speed [N s2/m2]
  double valve_skew = 0.0;            ///< factor on the flow: 1 + this outwards, 1 - this inwards
  double oil_drift = 0.0;             ///< relative change in the bulk modulus over a record
  double supply_drift = 0.0;          ///< relative decrease in the supply pressure over a record
  double volume_bow = 0.0;            ///< relative decrease in the oil volume towards either end
  double reference_lag_s = 0.0;       ///< lag of a filter in front of the controller
  double spike_m = 0.0;               ///< error of one sample in two hundred, of either sign
  double quantum_m = 0.0;  ///< resolution of the converter; the noise includes its quantisation

  double area_error = 0.0;  ///< true over stated piston area, minus 1
  double return_pa = 0.0;   ///< pressure in the return line
  double back_pressure =
      0.0;  ///< fraction of the supply lost at full flow; rises with the flow squared
  double oil_stiffening = 0.0;  ///< relative rise of the bulk modulus at supply pressure
  double valve_curve = 0.0;     ///< relative rise of the valve's gain at full command
  double underlap_v = 0.0;      ///< half-width of the range in which the valve's gain is double
  double slew_v_per_s = 0.0;    ///< largest rate of the spool signal; 0: none
  double supply_ripple = 0.0;   ///< relative amplitude of 50 Hz in the supply pressure
  double accumulator = 0.0;     ///< fraction of the supply lost in 0.5 s of full flow; recovers
  /// Fraction of the supply that a steady full flow takes from the end of a supply line, which
  /// resonates at 30 Hz.
  double line_drop = 0.0;
  double supply_step = 0.0;        ///< relative drop of the supply midway through a record
  double leak_drift = 0.0;         ///< relative rise of the leak over a record
  double leak_by_travel = 0.0;     ///< relative change of the leak towards either end
  double leak_power = 0.0;         ///< added to the leak's exponent of 0.5
  double sided_friction_n = 0.0;   ///< friction outwards only
  double travel_friction_n = 0.0;  ///< friction at one end; none at the other
  double late_friction_n = 0.0;    ///< friction in the second half of a record
  double fading_friction_n = 0.0;  ///< friction at the start of a record; decays in 0.3 s
  double constant_force_n = 0.0, spring_n_per_m = 0.0;
  double loose_mass = 0.0;        ///< fraction of the mass that hangs on a spring of 80 Hz
  double bracket = 0.0;           ///< coupling of the acceleration to a sensor bracket of 80 Hz
  double reader_lag_s = 0.0;      ///< lag of a Butterworth filter of second order behind the sensor
  double sensor_hum_m = 0.0;      ///< amplitude of 50 Hz on the reading, in phase with each start
  double sensor_drift_m = 0.0;    ///< drift of the reading over a record
  double sensor_jump_m = 0.0;     ///< jump of the reading midway through a record
  double clock_error = 0.0;       ///< relative error of the time stamps
  double filter_error = 0.0;      ///< true over stated derivative filter, minus 1
  double limit_error = 0.0;       ///< true over stated output limit, minus 1
  double reference_gain = 0.0;    ///< relative error of the reference
  double reference_step_m = 0.0;  ///< resolution of the reference
  double start_m = 0.0;           ///< position at the start of a record
  bool sensor_in_loop = false;    ///< whether the controller sees the sensor's errors (not its lag)
};

/// Returns the signed root of a pressure, which is straight well below `below` [Pa].
double smoothed_root(double pressure, double below);

/// Returns the reference at a time [m]; 0 before the record begins.
double reference_at(const Reference& reference, double t);

/// Returns the noise-free readings of the position sensor at 1 kHz, starting from rest.
std::vector<double> foreign_readings(const ForeignRig& rig, const Reference& reference);

}  // namespace rigcal::bench
