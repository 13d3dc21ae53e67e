#pragma once

#include <cmath>

#include "model/arithmetic/smooth.hpp"

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

/// Acceleration of a second mass on a spring and a damper [m/s2]:
/// omega_2^2 (x - x_2) + 2 zeta_2 omega_2 (x' - x_2').
///
/// @param travel_m, rate_m_per_s  x - x_2 and its rate
template <typename X, typename C>
X spring_and_damper(const X& travel_m, const X& rate_m_per_s, const C& frequency_rad_per_s,
                    const C& damping_ratio) {
  return travel_m * (frequency_rad_per_s * frequency_rad_per_s) +
         rate_m_per_s * (2.0 * damping_ratio * frequency_rad_per_s);
}

/// Load that varies with the travel [N]: k_F x + c_F x^2.
template <typename X, typename C>
X varying_load(const X& x, const C& gradient_n_per_m, const C& curvature_n_per_m2) {
  return (x * curvature_n_per_m2 + gradient_n_per_m) * x;
}

/// Opening of a metering edge that leaks while it is covered: c + y where it is open, c^2 / (c - y)
/// beyond, so that the leak fades as the land covers more of it. Continuous with its slope.
///
/// @param y  spool travel since the land's edge met the port's, positive when open
/// @param c  opening at y = 0, > 0, in the unit of y
/// @source   B. Eryilmaz and B. H. Wilson, Unified modeling and analysis of a proportional valve,
///           J. Franklin Institute 343 (2006) 48-68, with k = 1
template <typename X, typename C>
X leaking_opening(const X& y, const C& c) {
  if (value_of(y) > 0.0) return y + c;
  return c * c / (c - y);
}

/// Opening of one orifice that passes the flow of an edge in series with a fixed orifice: 1 / o^2 =
/// 1 / y^2 + 1 / l^2.
///
/// @param y  opening of the edge, >= 0
/// @param l  opening that represents bores and lines, > 0, in the unit of y
template <typename X, typename C>
X series_opening(const X& y, const C& l) {
  using std::sqrt;
  const X share = y / l;
  return y / sqrt(share * share + 1.0);
}

/// Flow through an orifice and a line with laminar loss [m3/s], Q = G sgn(P) sqrt(|P - R Q|):
/// 2 G P / (G R + sqrt((G R)^2 + 4 |P|)).
///
/// @param head_pa      P, of orifice and line together
/// @param conductance  G, flow of the orifice per root of pressure, >= 0
/// @param resistance   R of the line [Pa s/m3], >= 0
template <typename X, typename C>
X flow_before_line(const X& head_pa, const X& conductance, const C& resistance,
                   const C& smoothing_pa) {
  using std::sqrt;
  const X line = conductance * resistance;
  const X size_pa = sqrt(X(head_pa * head_pa + smoothing_pa * smoothing_pa));
  return 2.0 * conductance * head_pa / (line + sqrt(X(line * line + 4.0 * size_pa)));
}

/// Opening by a power law, y_r (y / y_r)^n, as of an edge with notches.
///
/// @param y        signal beyond the dead band, > 0
/// @param range    y_r, signal at which it is that of n = 1, in the unit of y
/// @param exponent n >= 1
template <typename X, typename C>
X power_opening(const X& y, const C& range, const C& exponent) {
  using std::exp;
  using std::log;
  return exp(X(log(X(y / range)) * exponent)) * range;
}

/// Largest flow of a pump that rises from one value to a second [m3/s]:
/// Q_1 + (Q_2 - Q_1) (1 + tanh((t - T_2) / tau_2)) / 2.
///
/// @param demand_s  t, time for which it has been asked for flow
template <typename X, typename C>
X two_stages(const X& demand_s, const X& first, const C& second, const C& delay_s,
             const C& rise_s) {
  using std::tanh;
  return (tanh(X((demand_s - delay_s) / rise_s)) + 1.0) * (0.5 * (second - first)) + first;
}

/// Force of an end stop on the piston [N], away from the stop: k d (1 + lambda d'), never a pull.
///
/// @param depth_m     d, how far the piston is beyond the stop; no force where negative
/// @param approach_m_per_s  d'
/// @source   K. H. Hunt and F. R. E. Crossley, Coefficient of restitution interpreted as damping in
///           vibroimpact, J. Applied Mechanics 42 (1975) 440-445, with exponent 1
template <typename X, typename C>
X stop_force(const X& depth_m, const X& approach_m_per_s, const C& stiffness_n_per_m,
             const C& damping_s_per_m) {
  return positive_part(depth_m) * stiffness_n_per_m *
         positive_part(X(approach_m_per_s * damping_s_per_m + 1.0));
}

constexpr double kAtmosphere_pa = 101325.0;

/// Absolute pressure [Pa] of one that counts from the atmosphere; at 1 kPa its fall ends.
template <typename X>
X absolute_pressure(const X& pressure_pa) {
  constexpr double kLeast_pa = 1e3;
  return at_least(X(pressure_pa + kAtmosphere_pa), kLeast_pa);
}

/// Change of pressure after a turn over which a hose begins to yield [Pa]. The threads of a braid
/// are locked by dry friction, which grows with the pressure that presses them together.
///
/// @param constant_pa  constant part
/// @param ratio        ratio of the other part to the absolute pressure
/// @source   B. Tondu and P. Lopez, Modeling and control of McKibben artificial muscle robot
///           actuators, IEEE Control Systems Magazine 20 (2000) 2, 15-38: the thread's friction
template <typename X, typename C>
X hose_yield(const X& pressure_pa, const C& constant_pa, const C& ratio) {
  return absolute_pressure(pressure_pa) * ratio + constant_pa;
}

/// Fraction of a braided hose that yields to a change of pressure: none when the pressure turns,
/// all of it after a long change in one direction.
///
/// @param memory  z, from -1 (has yielded to falling pressure) to 1 (to rising); it follows
///                z' = (1 - share) p' / hose_yield()
/// @param rises   whether the pressure rises now
/// @source   an operator of the kind of Bouc and Wen: Y.-K. Wen, Method for random vibration of
///           hysteretic systems, J. Engineering Mechanics Division 102 (1976) 249-263; the
///           exponent 2 from the records of docs/festo.md
template <typename X>
X yielding_share(const X& memory, bool rises) {
  const X along = rises ? X(memory) : X(-memory);
  const X half = positive_part(X(0.5 * along + 0.5));
  return value_of(half) < 1.0 ? X(half * half) : X(half * 0.0 + 1.0);
}

/// Bulk modulus of oil with undissolved air [Pa]: the air is compressed polytropically, the oil at
/// its own modulus.
///
///   beta = (1 - a + a r) / ((1 - a) / beta_l + a r / (n p)),  r = (p_0 / p)^(1/n)
///
/// @param pressure_pa  above atmosphere; at 1 kPa absolute the fall ends
/// @param air_fraction a, volume share at atmospheric pressure p_0
/// @source   H. Gholizadeh, R. Burton and G. Schoenau, Fluid bulk modulus: a literature survey,
/// Int.
///           J. Fluid Power 12 (2011) 5-15: the compression only model
template <typename X, typename C>
X aerated_bulk_modulus(const X& pressure_pa, const C& oil_pa, const C& air_fraction,
                       const C& exponent) {
  using std::exp;
  using std::log;
  const X p = absolute_pressure(pressure_pa);
  const X air = exp(log(kAtmosphere_pa / p) / exponent) * air_fraction;
  const C oil = 1.0 - air_fraction;
  return (air + oil) / (air / (p * exponent) + oil / oil_pa);
}

}  // namespace rigcal::model
