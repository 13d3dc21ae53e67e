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
/// signal, lagged reference, position and velocity of a loose mass, deflection of a sensor bracket
/// and its rate, pressure that an accumulator has lost [fraction of the supply], and pressure that
/// the end of a supply line has lost [the same] and its rate.
using ForeignState = std::array<double, 15>;

/// The part of the state that changes only between steps.
struct Memory {
  double played = 0.0;  ///< spool signal after the play
  double held = 0.0;    ///< command of a sampled controller
  double slewed = 0.0;  ///< spool signal of a valve with a limited rate
  double read = 0.0;    ///< reading after the play of the sensor
};

/// Resonance of a loose mass and of a sensor bracket, and their damping ratio.
constexpr double kLoose_rad_per_s = 2.0 * std::numbers::pi * 80.0;
constexpr double kLooseDamping = 0.05;
/// Resonance of a supply line, and its damping ratio.
constexpr double kLine_rad_per_s = 2.0 * std::numbers::pi * 30.0;
constexpr double kLineDamping = 0.1;
constexpr double kHum_rad_per_s = 2.0 * std::numbers::pi * 50.0;
/// Times in which an accumulator recovers, and in which the friction of a cold seal fades.
constexpr double kRecovery_s = 0.5;
constexpr double kFading_s = 0.3;
/// Load pressure at which a leak of another power equals that of the orifice [fraction of the
/// supply].
constexpr double kUsualLoad = 0.1;

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

double filter_of(const ForeignRig& rig) { return rig.filter_rad_per_s * (1.0 + rig.filter_error); }

/// Returns the command that the controller requests, before it is limited.
double wanted_command(const ForeignRig& rig, const ForeignState& s, double error) {
  const double kp = rig.kp_v_per_m + rig.kp_error_v_per_m;
  const double kd = rig.kd_v_s_per_m + rig.kd_error_v_s_per_m;
  return kp * error + s[4] + kd * filter_of(rig) * (error - s[3]);
}

double limited(const ForeignRig& rig, double volts) {
  const double limit = rig.limit_v * (1.0 + rig.limit_error);
  return std::clamp(volts, -limit, limit);
}

/// Returns the reading of a sensor with gain, offset and nonlinearity.
double bent(const ForeignRig& rig, double position) {
  const double turn = position * rig.area_m2 / rig.volume_m3;
  return position * (1.0 + rig.sensor_gain) * (1.0 + rig.loop_gain) + rig.sensor_offset_m +
         rig.sensor_bow_m * 4.0 * turn * turn +
         rig.sensor_wave_m * std::sin(2.0 * std::numbers::pi * turn);
}

double with_sensor_play(const ForeignRig& rig, double read, double reading) {
  return std::clamp(read, reading - rig.sensor_hysteresis_m, reading + rig.sensor_hysteresis_m);
}

/// Returns the position that the controller sees.
double seen_position(const ForeignRig& rig, double position, double read) {
  return rig.sensor_in_loop ? with_sensor_play(rig, read, bent(rig, position))
                            : (1.0 + rig.loop_gain) * position;
}

/// Returns the reference that the controller receives.
double given_reference(const ForeignRig& rig, const Reference& reference, double t) {
  const double value = (1.0 + rig.reference_gain) * reference_at(reference, t);
  return rig.reference_step_m > 0.0
             ? rig.reference_step_m * std::round(value / rig.reference_step_m)
             : value;
}

/// Returns the acceleration of an oscillator at 80 Hz.
double ringing(double displacement, double velocity) {
  return -kLoose_rad_per_s * (kLoose_rad_per_s * displacement + 2.0 * kLooseDamping * velocity);
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

/// Returns the spool signal, whose rate may be limited.
double spool_of(const ForeignRig& rig, const ForeignState& s, const Memory& memory,
                double command) {
  return rig.slew_v_per_s > 0.0 ? memory.slewed : spool_signal(rig, s, command);
}

double command_at(const ForeignRig& rig, const ForeignState& s, const Memory& memory,
                  double reference) {
  if (rig.controller_tick_s > 0.0) return memory.held;
  return limited(rig, wanted_command(rig, s, reference - seen_position(rig, s[0], memory.read)));
}

double flow_through(const ForeignRig& rig, double volts, double load, double supply) {
  const double skew = volts < 0.0 ? 1.0 - rig.valve_skew : 1.0 + rig.valve_skew;
  const double curve = 1.0 + rig.valve_curve * std::abs(volts) / rig.limit_v;
  const double opened = volts + std::clamp(volts, -rig.underlap_v, rig.underlap_v);
  return skew * curve * valve_flow(rig, opened, load, supply);
}

/// Returns the flow of the leak at a load pressure.
double leak_flow(const ForeignRig& rig, double load, double end, double elapsed) {
  const double smaller = std::pow(std::abs(load) / (kUsualLoad * rig.supply_pa), rig.leak_power);
  return rig.leak_coefficient * (1.0 + rig.leak_drift * elapsed) *
             (1.0 + rig.leak_by_travel * end) * (rig.leak_power > 0.0 ? smaller : 1.0) *
             rig.leak_area_m2 * std::sqrt(2.0 / rig.density_kg_per_m3) *
             smoothed_root(load, rig.straight_below_pa) +
         rig.laminar_m3_per_s_pa * load;
}

/// Returns the force of all friction, and of a damping by the square of the speed.
double friction_force(const ForeignRig& rig, double velocity, double load, double end, double t,
                      double elapsed) {
  const double fading = velocity / 0.01;
  const double size =
      rig.friction_n + rig.breakaway_n * std::exp(-fading * fading) +
      rig.pressure_friction_m2 * std::abs(load) + (velocity > 0.0 ? rig.sided_friction_n : 0.0) +
      rig.travel_friction_n * 0.5 * (1.0 + end) + (elapsed > 0.5 ? rig.late_friction_n : 0.0) +
      rig.fading_friction_n * std::exp(-t / kFading_s);
  return rubbing(size, velocity) + rig.square_damping * velocity * std::abs(velocity);
}

/// @param elapsed  fraction of the record that has passed
ForeignState slope(const ForeignRig& rig, const ForeignState& s, const Memory& memory,
                   double reference, double t, double elapsed) {
  const double position = s[0];
  const double velocity = s[1];
  const double load = s[2];
  const double seen = rig.reference_lag_s > 0.0 ? s[7] : reference;
  const double error = seen - seen_position(rig, position, memory.read);
  const bool ticks = rig.controller_tick_s > 0.0;
  const double wanted = wanted_command(rig, s, error);
  const double command = command_at(rig, s, memory, seen);
  const double spool = with_play(rig, memory.played, spool_of(rig, s, memory, command));
  const double volts = without_band(spool + rig.null_shift_v, rig.dead_band_v);
  const double source = rig.supply_pa * (1.0 - rig.supply_drift * elapsed) *
                            (1.0 - (elapsed > 0.5 ? rig.supply_step : 0.0)) *
                            (1.0 + rig.supply_ripple * std::sin(kHum_rad_per_s * t)) *
                            (1.0 - s[12]) * (1.0 - s[13]) -
                        rig.return_pa;
  const double full = valve_flow(rig, rig.limit_v, 0.0, source);
  double supply = source;
  if (rig.sag > 0.0 || rig.back_pressure > 0.0) {
    for (int i = 0; i < 3; ++i) {  // flow and pressure drop depend on each other
      const double part = std::abs(flow_through(rig, volts, load, supply)) / full;
      supply = source * (1.0 - rig.sag * part - rig.back_pressure * part * part);
    }
  }
  const double flow = flow_through(rig, volts, load, supply);
  const double area = rig.area_m2 * (1.0 + rig.area_error);
  const double end = 2.0 * position * rig.area_m2 / rig.volume_m3;  // +-1 at the ends
  const double leak = leak_flow(rig, load, end, elapsed);
  const double friction = friction_force(rig, velocity, load, end, t, elapsed);
  const double oil = (rig.volume_m3 + rig.hose_volume_m3) * (1.0 - rig.volume_bow * end * end);
  const double stiffness = 4.0 * rig.bulk_modulus_pa * (1.0 + rig.oil_drift * elapsed) *
                           (1.0 + rig.oil_stiffening * std::abs(load) / rig.supply_pa) / oil;
  const double loose_kg = rig.loose_mass * rig.mass_kg;
  const double pull = loose_kg * ringing(s[8] - position, s[9] - velocity);
  ForeignState d{};
  d[0] = velocity;
  d[1] = (area * load - rig.damping_n_s_per_m * velocity - friction - pull + rig.constant_force_n -
          rig.spring_n_per_m * position) /
         (rig.mass_kg - loose_kg);
  d[2] = stiffness * (flow - leak - area * velocity);
  if (loose_kg > 0.0) {
    d[8] = s[9];
    d[9] = pull / loose_kg;
  }
  if (rig.bracket > 0.0) {
    d[10] = s[11];
    d[11] = ringing(s[10], s[11]) - rig.bracket * d[1];
  }
  d[12] = (rig.accumulator * std::abs(flow) / full - s[12]) / kRecovery_s;
  d[13] = s[14];
  d[14] = kLine_rad_per_s * (kLine_rad_per_s * (rig.line_drop * std::abs(flow) / full - s[13]) -
                             2.0 * kLineDamping * s[14]);
  if (!ticks) {
    d[3] = filter_of(rig) * (error - s[3]);
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
ForeignState stepped(const ForeignRig& rig, const Reference& reference, double t, double step_s,
                     const Memory& memory, const ForeignState& s) {
  // Both ends are evaluated a thousandth of a step inside, so that they are on the same side of an
  // edge that falls between two steps.
  const double inside = 1e-3 * step_s;
  const double first = given_reference(rig, reference, t - rig.delay_s + inside);
  const double middle = given_reference(rig, reference, t - rig.delay_s + 0.5 * step_s);
  const double last = given_reference(rig, reference, t - rig.delay_s + step_s - inside);
  const double elapsed = t / reference.duration_s;
  const ForeignState a = slope(rig, s, memory, first, t, elapsed);
  const ForeignState b =
      slope(rig, moved(s, a, 0.5 * step_s), memory, middle, t + 0.5 * step_s, elapsed);
  const ForeignState c =
      slope(rig, moved(s, b, 0.5 * step_s), memory, middle, t + 0.5 * step_s, elapsed);
  const ForeignState d = slope(rig, moved(s, c, step_s), memory, last, t + step_s, elapsed);
  ForeignState next = s;
  for (std::size_t i = 0; i < s.size(); ++i)
    next[i] += step_s / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
  return next;
}

/// Executes one tick of the sampled controller. The filter advances by backward Euler, the integral
/// by forward Euler.
void tick(const ForeignRig& rig, double reference, ForeignState& s, Memory& memory) {
  const double error = reference - seen_position(rig, s[0], memory.read);
  const double step = filter_of(rig) * rig.controller_tick_s;
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
  const double step_s = kStep_s * (1.0 + rig.clock_error);
  std::vector<double> readings;
  ForeignState state{};
  state[0] = rig.start_m;
  double lagged = rig.start_m;
  double filtered = rig.start_m;
  double rate = 0.0;
  double played = rig.start_m;
  Memory memory;
  const long steps_per_tick = std::lround(rig.controller_tick_s / kStep_s);
  for (std::size_t k = 0; k < samples; ++k) {
    const double elapsed = static_cast<double>(k) / 1000.0 / reference.duration_s;
    played = with_sensor_play(rig, played, bent(rig, filtered + state[10]));
    readings.push_back(played +
                       rig.sensor_hum_m * std::sin(kHum_rad_per_s * static_cast<double>(k) / 1e3) +
                       rig.sensor_drift_m * elapsed + (elapsed > 0.5 ? rig.sensor_jump_m : 0.0));
    for (int i = 0; i < kStepsPerSample; ++i) {
      const long step = static_cast<long>(k) * kStepsPerSample + i;
      const double t = static_cast<double>(step) * step_s;
      const double now = given_reference(rig, reference, t - rig.delay_s + 1e-3 * step_s);
      if (steps_per_tick > 0 && step % steps_per_tick == 0) tick(rig, now, state, memory);
      state = stepped(rig, reference, t, step_s, memory, state);
      const double seen = rig.reference_lag_s > 0.0 ? state[7] : now;
      const double command = command_at(rig, state, memory, seen);
      const double most = rig.slew_v_per_s * step_s;
      memory.slewed += std::clamp(spool_signal(rig, state, command) - memory.slewed, -most, most);
      memory.played = with_play(rig, memory.played, spool_of(rig, state, memory, command));
      memory.read = seen_position(rig, state[0], memory.read);
      lagged = rig.sensor_lag_s > 0.0
                   ? state[0] + (lagged - state[0]) * std::exp(-step_s / rig.sensor_lag_s)
                   : state[0];
      if (rig.reader_lag_s > 0.0) {
        const double omega = std::numbers::sqrt2 / rig.reader_lag_s;
        rate += step_s * omega * (omega * (lagged - filtered) - std::numbers::sqrt2 * rate);
        filtered += step_s * rate;
      } else {
        filtered = lagged;
      }
    }
  }
  return readings;
}

}  // namespace rigcal::bench
