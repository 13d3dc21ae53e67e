#include "bench/foreign_rig.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace rigcal::bench {
namespace {

constexpr double kStep_s = 1e-5;  // a third of the stability limit due to the leak's smoothed root
constexpr int kStepsPerSample = 100;

/// Position, velocity, load pressure, filtered error, integral, spool signal, rate of the spool
/// signal, and lagged reference.
using ForeignState = std::array<double, 8>;

/// The part of the state that changes only between steps.
struct Memory {
  double played = 0.0;  ///< spool signal after the play
  double held = 0.0;    ///< command of a sampled controller
};

double without_band(double volts, double half_width) {
  if (volts > half_width) return volts - half_width;
  return volts < -half_width ? volts + half_width : 0.0;
}

double valve_flow(const ForeignRig& rig, double volts, double load, double supply) {
  const double head = volts < 0.0 ? supply + load : supply - load;
  return rig.valve_gain_m_per_v * volts * rig.discharge * rig.gradient_m /
         std::sqrt(rig.density_kg_per_m3) * smoothed_root(head, rig.straight_below_pa);
}

/// Returns a friction force that grows with speed and reaches its full size at a few millimetres
/// per second.
double rubbing(double size, double velocity) { return size * std::tanh(velocity / 1e-3); }

/// Returns the command that the controller requests, before it is limited.
double wanted_command(const ForeignRig& rig, const ForeignState& s, double error) {
  const double kp = rig.kp_v_per_m + rig.kp_error_v_per_m;
  const double kd = rig.kd_v_s_per_m + rig.kd_error_v_s_per_m;
  return kp * error + s[4] + kd * rig.filter_rad_per_s * (error - s[3]);
}

double limited(const ForeignRig& rig, double volts) {
  return std::clamp(volts, -rig.limit_v, rig.limit_v);
}

double with_play(const ForeignRig& rig, double played, double spool) {
  return rig.valve_play_v > 0.0
             ? std::clamp(played, spool - rig.valve_play_v, spool + rig.valve_play_v)
             : spool;
}

/// Returns the signal that the spool follows, given the command of the controller.
double spool_signal(const ForeignRig& rig, const ForeignState& s, double command) {
  return rig.valve_lag_s > 0.0 || rig.valve_corner_hz > 0.0 ? s[5] : command;
}

double command_at(const ForeignRig& rig, const ForeignState& s, const Memory& memory,
                  double reference) {
  return rig.controller_tick_s > 0.0 ? memory.held
                                     : limited(rig, wanted_command(rig, s, reference - s[0]));
}

double flow_through(const ForeignRig& rig, double volts, double load, double supply) {
  const double skew = volts < 0.0 ? 1.0 - rig.valve_skew : 1.0 + rig.valve_skew;
  return skew * valve_flow(rig, volts, load, supply);
}

/// @param elapsed  fraction of the record that has passed
ForeignState slope(const ForeignRig& rig, const ForeignState& s, const Memory& memory,
                   double reference, double elapsed) {
  const double position = s[0];
  const double velocity = s[1];
  const double load = s[2];
  const double seen = rig.reference_lag_s > 0.0 ? s[7] : reference;
  const double error = seen - position;
  const bool ticks = rig.controller_tick_s > 0.0;
  const double wanted = wanted_command(rig, s, error);
  const double command = command_at(rig, s, memory, seen);
  const double spool = with_play(rig, memory.played, spool_signal(rig, s, command));
  const double volts = without_band(spool + rig.null_shift_v, rig.dead_band_v);
  const double source = rig.supply_pa * (1.0 - rig.supply_drift * elapsed);
  double supply = source;
  if (rig.sag > 0.0) {
    const double full = valve_flow(rig, rig.limit_v, 0.0, source);
    for (int i = 0; i < 3; ++i)  // flow and pressure drop depend on each other
      supply = source * (1.0 - rig.sag * std::abs(flow_through(rig, volts, load, supply)) / full);
  }
  const double leak = rig.leak_coefficient * rig.leak_area_m2 *
                          std::sqrt(2.0 / rig.density_kg_per_m3) *
                          smoothed_root(load, rig.straight_below_pa) +
                      rig.laminar_m3_per_s_pa * load;
  const double fading = velocity / 0.01;
  const double friction = rubbing(rig.friction_n + rig.breakaway_n * std::exp(-fading * fading) +
                                      rig.pressure_friction_m2 * std::abs(load),
                                  velocity) +
                          rig.square_damping * velocity * std::abs(velocity);
  const double end = 2.0 * position * rig.area_m2 / rig.volume_m3;  // +-1 at the ends
  const double oil = (rig.volume_m3 + rig.hose_volume_m3) * (1.0 - rig.volume_bow * end * end);
  const double stiffness = 4.0 * rig.bulk_modulus_pa * (1.0 + rig.oil_drift * elapsed) / oil;
  ForeignState d{};
  d[0] = velocity;
  d[1] = (rig.area_m2 * load - rig.damping_n_s_per_m * velocity - friction) / rig.mass_kg;
  d[2] = stiffness * (flow_through(rig, volts, load, supply) - leak - rig.area_m2 * velocity);
  if (!ticks) {
    d[3] = rig.filter_rad_per_s * (error - s[3]);
    d[4] = rig.integral_v_per_m_s * error +
           (command - wanted) * rig.integral_v_per_m_s / rig.kp_v_per_m;
  }
  if (rig.valve_corner_hz > 0.0) {
    const double omega = 2.0 * std::numbers::pi * rig.valve_corner_hz;
    d[5] = s[6];
    d[6] = omega * omega * (command - s[5]) - 1.4 * omega * s[6];
  } else if (rig.valve_lag_s > 0.0) {
    d[5] = (command - s[5]) / rig.valve_lag_s;
  }
  if (rig.reference_lag_s > 0.0) d[7] = (reference - s[7]) / rig.reference_lag_s;
  return d;
}

ForeignState moved(const ForeignState& s, const ForeignState& d, double h) {
  ForeignState result;
  for (std::size_t i = 0; i < s.size(); ++i) result[i] = s[i] + h * d[i];
  return result;
}

/// Advances by one step. If the reference jumps within the step, its value in the middle of the
/// step is used; otherwise the reference is exact.
ForeignState stepped(const ForeignRig& rig, const Reference& reference, double t,
                     const Memory& memory, const ForeignState& s) {
  // Both ends are evaluated a thousandth of a step inside, so that they are on the same side of an
  // edge that falls between two steps.
  const double inside = 1e-3 * kStep_s;
  const double first = reference_at(reference, t - rig.delay_s + inside);
  const double middle = reference_at(reference, t - rig.delay_s + 0.5 * kStep_s);
  const double last = reference_at(reference, t - rig.delay_s + kStep_s - inside);
  const double elapsed = t / reference.duration_s;
  const ForeignState a = slope(rig, s, memory, first, elapsed);
  const ForeignState b = slope(rig, moved(s, a, 0.5 * kStep_s), memory, middle, elapsed);
  const ForeignState c = slope(rig, moved(s, b, 0.5 * kStep_s), memory, middle, elapsed);
  const ForeignState d = slope(rig, moved(s, c, kStep_s), memory, last, elapsed);
  ForeignState next = s;
  for (std::size_t i = 0; i < s.size(); ++i)
    next[i] += kStep_s / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
  return next;
}

/// Executes one tick of the sampled controller. The filter advances by backward Euler, the integral
/// by forward Euler.
void tick(const ForeignRig& rig, double reference, ForeignState& s, Memory& memory) {
  const double error = reference - s[0];
  const double step = rig.filter_rad_per_s * rig.controller_tick_s;
  s[3] = (s[3] + step * error) / (1.0 + step);
  const double wanted = wanted_command(rig, s, error);
  memory.held = limited(rig, wanted);
  s[4] += rig.controller_tick_s * rig.integral_v_per_m_s *
          (error + (memory.held - wanted) / rig.kp_v_per_m);
}

}  // namespace

double smoothed_root(double pressure, double below) {
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

std::vector<double> foreign_readings(const ForeignRig& rig, const Reference& reference) {
  const auto samples = static_cast<std::size_t>(reference.duration_s * 1000.0 + 1.5);
  const double range = rig.volume_m3 / rig.area_m2;
  std::vector<double> readings;
  ForeignState state{};
  double lagged = 0.0;
  double played = 0.0;
  Memory memory;
  const long steps_per_tick = std::lround(rig.controller_tick_s / kStep_s);
  for (std::size_t k = 0; k < samples; ++k) {
    const double turn = lagged / range;
    const double bent = lagged * (1.0 + rig.sensor_gain) + rig.sensor_offset_m +
                        rig.sensor_bow_m * 4.0 * turn * turn +
                        rig.sensor_wave_m * std::sin(2.0 * std::numbers::pi * turn);
    played = std::clamp(played, bent - rig.sensor_hysteresis_m, bent + rig.sensor_hysteresis_m);
    readings.push_back(played);
    for (int i = 0; i < kStepsPerSample; ++i) {
      const long step = static_cast<long>(k) * kStepsPerSample + i;
      const double t = static_cast<double>(step) * kStep_s;
      const double now = reference_at(reference, t - rig.delay_s + 1e-3 * kStep_s);
      if (steps_per_tick > 0 && step % steps_per_tick == 0) tick(rig, now, state, memory);
      state = stepped(rig, reference, t, memory, state);
      const double seen = rig.reference_lag_s > 0.0 ? state[7] : now;
      memory.played = with_play(rig, memory.played,
                                spool_signal(rig, state, command_at(rig, state, memory, seen)));
      lagged = rig.sensor_lag_s > 0.0
                   ? state[0] + (lagged - state[0]) * std::exp(-kStep_s / rig.sensor_lag_s)
                   : state[0];
    }
  }
  return readings;
}

}  // namespace rigcal::bench
