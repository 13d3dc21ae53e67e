#pragma once

#include <cmath>

#include "model/smooth.hpp"

namespace rigcal::model {

/// Flow of a servo valve per spool travel and root of pressure: C_d w / sqrt(rho).
template <typename C>
C valve_conductance(const C& discharge_coefficient, const C& area_gradient_m,
                    const C& density_kg_per_m3) {
  using std::sqrt;
  return discharge_coefficient * area_gradient_m / sqrt(density_kg_per_m3);
}

/// Flow of a matched symmetric servo valve to the load, eqs. 4, 6, 7 with the sign put right:
/// Q = C_d w x_v sqrt((P_s - sgn(x_v) P_L) / rho).
///
/// @param spool_m      x_v [m]
/// @param conductance  valve_conductance()
/// @return             [m3/s], positive into chamber A
/// @deviation          the paper prints P_s - P_L for both signs; the root is signed and
///                     straightened within `smoothing_pa`, so that the flow reverses when P_L
///                     passes P_s
template <typename X, typename C, typename S>
X servo_flow(const X& spool_m, const X& load_pressure_pa, const S& supply_pressure_pa,
             const C& conductance, const C& smoothing_pa) {
  const X head = value_of(spool_m) < 0.0 ? X(supply_pressure_pa + load_pressure_pa)
                                         : X(supply_pressure_pa - load_pressure_pa);
  return spool_m * conductance * signed_sqrt(head, smoothing_pa);
}

/// Flow of the leak per root of pressure: C_leak w_leak sqrt(2 / rho).
template <typename C>
C orifice_conductance(const C& coefficient, const C& area_m2, const C& density_kg_per_m3) {
  using std::sqrt;
  return coefficient * area_m2 * sqrt(2.0 / density_kg_per_m3);
}

/// Turbulent internal leakage, eq. 11: C_leak w_leak sgn(P_L) sqrt(2 |P_L| / rho).
///
/// @param conductance  orifice_conductance()
template <typename X, typename C>
X orifice_leakage(const X& load_pressure_pa, const C& conductance, const C& smoothing_pa) {
  return signed_sqrt(load_pressure_pa, smoothing_pa) * conductance;
}

/// Dry friction: (F_c + F_st exp(-(v / v_st)^2)) sgn(v), the sign straightened within v_0.
template <typename X, typename C>
X dry_friction(const X& velocity_m_per_s, const C& coulomb_n, const C& stribeck_n,
               const C& stribeck_velocity_m_per_s, const C& smoothing_m_per_s) {
  using std::exp;
  const X ratio = velocity_m_per_s / stribeck_velocity_m_per_s;
  return (coulomb_n + stribeck_n * exp(-(ratio * ratio))) *
         smooth_sign(velocity_m_per_s, smoothing_m_per_s);
}

}  // namespace rigcal::model
