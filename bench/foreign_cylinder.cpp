#include "bench/foreign_cylinder.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/foreign_rig.hpp"

namespace rigcal::bench {
namespace {

/// A hundredth of a millisecond: a thousandth of the period of the hydraulic mode (93 Hz).
constexpr double kCylinderStep_s = 1e-5;
constexpr int kStepsPerReading = 100;

/// Position, velocity, and the pressures of both chambers.
using CylinderState = std::array<double, 4>;

double leak_of(const ForeignCylinder& rig, double load) {
  return rig.leak_coefficient * rig.leak_area_m2 * std::sqrt(2.0 / rig.density_kg_per_m3) *
             smoothed_root(load, rig.straight_below_pa) +
         rig.laminar_m3_per_s_pa * load;
}

CylinderState rate(const ForeignCylinder& rig, const CylinderState& s, double reference) {
  const double volts = std::clamp(rig.kp_v_per_m * (reference - s[0]), -rig.limit_v, rig.limit_v);
  const double opening = rig.discharge * rig.gradient_m * rig.valve_gain_m_per_v * std::abs(volts) *
                         std::sqrt(2.0 / rig.density_kg_per_m3);
  const auto through = [&](double from, double to) {
    return opening * smoothed_root(from - to, rig.straight_below_pa);
  };
  const bool out = volts > 0.0;
  const double into_a = out ? through(rig.supply_pa, s[2]) : -through(s[2], rig.tank_pa);
  const double into_b = out ? -through(s[3], rig.tank_pa) : through(rig.supply_pa, s[3]);
  const double leak = leak_of(rig, s[2] - s[3]);
  const double middle = rig.dead_volume_m3 + 0.5 * rig.stroke_m * rig.area_m2;
  const double displaced = rig.area_m2 * s[0];
  return {s[1], (rig.area_m2 * (s[2] - s[3]) - rig.damping_n_s_per_m * s[1]) / rig.mass_kg,
          rig.bulk_modulus_pa * (into_a - leak - rig.area_m2 * s[1]) / (middle + displaced),
          rig.bulk_modulus_pa * (into_b + leak + rig.area_m2 * s[1]) / (middle - displaced)};
}

CylinderState shifted(const CylinderState& s, const CylinderState& d, double h) {
  CylinderState result;
  for (std::size_t i = 0; i < s.size(); ++i) result[i] = s[i] + h * d[i];
  return result;
}

/// Advances by one step of the classical Runge-Kutta method. Both ends are evaluated a thousandth
/// of a step inside, so that they are on the same side of an edge that falls between two steps.
CylinderState advanced(const ForeignCylinder& rig, const Reference& reference, double t,
                       const CylinderState& s) {
  const double h = kCylinderStep_s;
  const double middle = reference_at(reference, t + 0.5 * h);
  const CylinderState a = rate(rig, s, reference_at(reference, t + 1e-3 * h));
  const CylinderState b = rate(rig, shifted(s, a, 0.5 * h), middle);
  const CylinderState c = rate(rig, shifted(s, b, 0.5 * h), middle);
  const CylinderState d = rate(rig, shifted(s, c, h), reference_at(reference, t + h - 1e-3 * h));
  CylinderState next = s;
  for (std::size_t i = 0; i < s.size(); ++i)
    next[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
  return next;
}

}  // namespace

CylinderReadings foreign_readings(const ForeignCylinder& rig, const Reference& reference) {
  const auto samples = static_cast<std::size_t>(reference.duration_s * 1000.0 + 1.5);
  const double half = 0.5 * (rig.supply_pa + rig.tank_pa);
  CylinderState state{0.0, 0.0, half, half};
  CylinderReadings readings;
  for (std::size_t k = 0; k < samples; ++k) {
    readings.position_m.push_back(state[0]);
    readings.pressure_a_pa.push_back(state[2]);
    readings.pressure_b_pa.push_back(state[3]);
    readings.leak_m3_per_s +=
        std::abs(leak_of(rig, state[2] - state[3])) / static_cast<double>(samples);
    for (int i = 0; i < kStepsPerReading; ++i) {
      const long step = static_cast<long>(k) * kStepsPerReading + i;
      state = advanced(rig, reference, static_cast<double>(step) * kCylinderStep_s, state);
    }
  }
  return readings;
}

}  // namespace rigcal::bench
