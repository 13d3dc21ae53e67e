#include "bench/foreign_rig.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace rigcal::bench {
namespace {

constexpr double kStep_s = 1e-5;  // a third of what the straightened root of the leak allows
constexpr int kStepsPerSample = 100;

/// Position, velocity, load pressure, filtered error, integral, spool signal.
using ForeignState = std::array<double, 6>;

double straightened_root(double pressure, double below) {
  return pressure / std::pow(pressure * pressure + below * below, 0.25);
}

double reference_at(const Reference& reference, double t) {
  if (t < 0.0) return 0.0;
  const double phase = reference.frequency_hz * t;
  if (reference.waveform == "sine")
    return reference.amplitude_m * std::sin(2.0 * std::numbers::pi * phase);
  const double within = phase - std::floor(phase);
  return within < 0.5 ? reference.amplitude_m : -reference.amplitude_m;
}

double without_band(double volts, double half_width) {
  if (volts > half_width) return volts - half_width;
  return volts < -half_width ? volts + half_width : 0.0;
}

double valve_flow(const ForeignRig& rig, double volts, double load, double supply) {
  const double head = volts < 0.0 ? supply + load : supply - load;
  return rig.valve_gain_m_per_v * volts * rig.discharge * rig.gradient_m /
         std::sqrt(rig.density_kg_per_m3) * straightened_root(head, rig.straight_below_pa);
}

ForeignState slope(const ForeignRig& rig, const ForeignState& s, double reference) {
  const double position = s[0];
  const double velocity = s[1];
  const double load = s[2];
  const double error = reference - position;
  const double kp = rig.kp_v_per_m + rig.kp_error_v_per_m;
  const double kd = rig.kd_v_s_per_m + rig.kd_error_v_s_per_m;
  const double wanted = kp * error + s[4] + kd * rig.filter_rad_per_s * (error - s[3]);
  const double command = std::clamp(wanted, -rig.limit_v, rig.limit_v);
  const double spool = rig.valve_lag_s > 0.0 ? s[5] : command;
  const double volts = without_band(spool + rig.null_shift_v, rig.dead_band_v);
  double supply = rig.supply_pa;
  if (rig.sag > 0.0) {
    const double full = valve_flow(rig, rig.limit_v, 0.0, rig.supply_pa);
    for (int i = 0; i < 3; ++i)  // the flow through the line is that which its fall allows
      supply =
          rig.supply_pa * (1.0 - rig.sag * std::abs(valve_flow(rig, volts, load, supply)) / full);
  }
  const double leak = rig.leak_coefficient * rig.leak_area_m2 *
                          std::sqrt(2.0 / rig.density_kg_per_m3) *
                          straightened_root(load, rig.straight_below_pa) +
                      rig.laminar_m3_per_s_pa * load;
  const double friction = rig.friction_n * std::tanh(velocity / 1e-3);
  ForeignState d{};
  d[0] = velocity;
  d[1] = (rig.area_m2 * load - rig.damping_n_s_per_m * velocity - friction) / rig.mass_kg;
  d[2] = 4.0 * rig.bulk_modulus_pa / (rig.volume_m3 + rig.hose_volume_m3) *
         (valve_flow(rig, volts, load, supply) - leak - rig.area_m2 * velocity);
  d[3] = rig.filter_rad_per_s * error - rig.filter_rad_per_s * s[3];
  d[4] =
      rig.integral_v_per_m_s * error + (command - wanted) * rig.integral_v_per_m_s / rig.kp_v_per_m;
  d[5] = rig.valve_lag_s > 0.0 ? (command - s[5]) / rig.valve_lag_s : 0.0;
  return d;
}

ForeignState moved(const ForeignState& s, const ForeignState& d, double h) {
  ForeignState result;
  for (std::size_t i = 0; i < s.size(); ++i) result[i] = s[i] + h * d[i];
  return result;
}

/// A step within which the reference is that of its middle where it jumps, and exact elsewhere.
ForeignState stepped(const ForeignRig& rig, const Reference& reference, double t,
                     const ForeignState& s) {
  // Half a step's thousandth inside, so that both ends lie on one side of an edge.
  const double inside = 1e-3 * kStep_s;
  const double first = reference_at(reference, t - rig.delay_s + inside);
  const double middle = reference_at(reference, t - rig.delay_s + 0.5 * kStep_s);
  const double last = reference_at(reference, t - rig.delay_s + kStep_s - inside);
  const ForeignState a = slope(rig, s, first);
  const ForeignState b = slope(rig, moved(s, a, 0.5 * kStep_s), middle);
  const ForeignState c = slope(rig, moved(s, b, 0.5 * kStep_s), middle);
  const ForeignState d = slope(rig, moved(s, c, kStep_s), last);
  ForeignState next = s;
  for (std::size_t i = 0; i < s.size(); ++i)
    next[i] += kStep_s / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
  return next;
}

}  // namespace

std::vector<double> foreign_readings(const ForeignRig& rig, const Reference& reference) {
  const auto samples = static_cast<std::size_t>(reference.duration_s * 1000.0 + 1.5);
  const double range = rig.volume_m3 / rig.area_m2;
  std::vector<double> readings;
  ForeignState state{};
  double lagged = 0.0;
  double played = 0.0;
  for (std::size_t k = 0; k < samples; ++k) {
    const double turn = lagged / range;
    const double bent = lagged * (1.0 + rig.sensor_gain) + rig.sensor_offset_m +
                        rig.sensor_bow_m * 4.0 * turn * turn +
                        rig.sensor_wave_m * std::sin(2.0 * std::numbers::pi * turn);
    played = std::clamp(played, bent - rig.sensor_hysteresis_m, bent + rig.sensor_hysteresis_m);
    readings.push_back(played);
    for (int i = 0; i < kStepsPerSample; ++i) {
      const double t = (static_cast<double>(k) * kStepsPerSample + i) * kStep_s;
      state = stepped(rig, reference, t, state);
      lagged = rig.sensor_lag_s > 0.0
                   ? state[0] + (lagged - state[0]) * std::exp(-kStep_s / rig.sensor_lag_s)
                   : state[0];
    }
  }
  return readings;
}

}  // namespace rigcal::bench
