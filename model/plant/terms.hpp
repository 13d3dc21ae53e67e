#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "model/arithmetic/smooth.hpp"

namespace rigcal::model {

/// Flow through a servo valve per spool travel and square root of pressure: C_d w / sqrt(rho).
template <typename C>
C valve_conductance(const C& discharge_coefficient, const C& area_gradient_m,
                    const C& density_kg_per_m3) {
  using std::sqrt;
  return discharge_coefficient * area_gradient_m / sqrt(density_kg_per_m3);
}

/// Flow of a matched symmetric servo valve to the load, eqs. 4, 6, 7 with the sign corrected:
/// Q = C_d w x_v sqrt((P_s - sgn(x_v) P_L) / rho).
///
/// @param spool_m      x_v [m]
/// @param conductance  valve_conductance()
/// @return             [m3/s], positive into chamber A
/// @deviation          the paper has P_s - P_L for both signs. Here the root is signed, and
///                     smoothed within `smoothing_pa`, so that the flow reverses when P_L exceeds
///                     P_s
template <typename X, typename C, typename S>
X servo_flow(const X& spool_m, const X& load_pressure_pa, const S& supply_pressure_pa,
             const C& conductance, const C& smoothing_pa) {
  const X head = value_of(spool_m) < 0.0 ? X(supply_pressure_pa + load_pressure_pa)
                                         : X(supply_pressure_pa - load_pressure_pa);
  return spool_m * conductance * signed_sqrt(head, smoothing_pa);
}

/// Leakage flow per square root of pressure: C_leak w_leak sqrt(2 / rho).
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

/// Magnitude of the dry friction in steady sliding [N]: F_c + F_st exp(-(v / v_st)^2).
template <typename X, typename C>
X sliding_friction(const X& velocity_m_per_s, const C& coulomb_n, const C& stribeck_n,
                   const C& stribeck_velocity_m_per_s) {
  using std::exp;
  const X ratio = velocity_m_per_s / stribeck_velocity_m_per_s;
  return coulomb_n + stribeck_n * exp(-(ratio * ratio));
}

/// Dry friction: the friction of steady sliding times sgn(v), with the sign smoothed within v_0.
template <typename X, typename C>
X dry_friction(const X& velocity_m_per_s, const C& coulomb_n, const C& stribeck_n,
               const C& stribeck_velocity_m_per_s, const C& smoothing_m_per_s) {
  return sliding_friction(velocity_m_per_s, coulomb_n, stribeck_n, stribeck_velocity_m_per_s) *
         smooth_sign(velocity_m_per_s, smoothing_m_per_s);
}

/// Time derivative of the bristle force, F_b' = sigma_0 (v - |v| F_b / g(v)). The bristles bend
/// until their force reaches g(v), and then slide.
///
/// @param sliding_n  g(v), sliding_friction()
/// @source   C. Canudas de Wit, H. Olsson, K. J. Astrom and P. Lischinsky, A new model for control
///           of systems with friction, IEEE Trans. Automatic Control 40 (1995) 419-425, with the
///           force F_b = sigma_0 z as the state
template <typename X, typename C>
X bristle_rate(const X& bristle_n, const X& velocity_m_per_s, const X& sliding_n,
               const C& stiffness_n_per_m) {
  constexpr double kLeast_n = 1e-6;
  const X speed = value_of(velocity_m_per_s) < 0.0 ? X(-velocity_m_per_s) : velocity_m_per_s;
  return (velocity_m_per_s - speed * bristle_n / at_least(sliding_n, kLeast_n)) * stiffness_n_per_m;
}

/// Thickness of the lubricant film in steady motion, relative to the thickest:
/// min(|v| / v_b, 1)^(2/3). The root is rounded within v_0.
///
/// @source  film_rate()
template <typename X, typename C>
X steady_film(const X& velocity_m_per_s, const C& film_velocity_m_per_s,
              const C& smoothing_m_per_s) {
  using std::exp;
  using std::log;
  const X square = velocity_m_per_s * velocity_m_per_s;
  const X rounded = (square + smoothing_m_per_s * smoothing_m_per_s) * film_velocity_m_per_s;
  const X film = square * exp(X(log(rounded) * (-2.0 / 3.0)));
  return value_of(film) < 1.0 ? film : X(1.0);
}

/// Time derivative of the relative thickness of the lubricant film [1/s]: h' = (h_ss - h) / tau.
/// tau is that of growth or decay in motion and, within v_0, that at rest.
///
/// @param steady    h_ss, steady_film()
/// @param moving_s  time constant of growth if h < h_ss, else that of decay in motion
/// @source   H. Yanada and Y. Sekikawa, Modeling of dynamic behaviors of friction, Mechatronics 18
///           (2008) 330-339. Their h is 1 - F_c / F_s times this one, F_s = F_c + F_st, so that
///           their (1 - h) F_s - F_c is F_st (1 - h) here. They have tau at rest only for v = 0
template <typename X, typename C>
X film_rate(const X& film, const X& steady, const X& velocity_m_per_s, const C& moving_s,
            const C& dwell_s, const C& smoothing_m_per_s) {
  using std::exp;
  const X ratio = velocity_m_per_s / smoothing_m_per_s;
  const X still = exp(X(-(ratio * ratio)));
  return (steady - film) * (still / dwell_s + (1.0 - still) / moving_s);
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

constexpr double kTablePieces = 5.0;  ///< between the six values of a table

/// Corner of a table that is closest to a place: one of its four inner values.
inline std::size_t closest_corner(double place) {
  const double nearest = std::round(place);
  return nearest > 1.0 ? static_cast<std::size_t>(std::min(nearest, kTablePieces - 1.0))
                       : std::size_t{1};
}

/// Interpolates linearly between six values at equal distances, and extrapolates the first and the
/// last piece. A parabola replaces each corner, so the slope is continuous.
///
/// @param place    0 at the first value, 5 at the last
/// @param rounded  fraction of a piece that the parabola covers to either side of its corner, up to
///                 0.5
template <typename X, typename C>
X rounded_table(const X& place, const std::array<C, 6>& values, double rounded) {
  const std::size_t corner = closest_corner(value_of(place));
  const C before = values[corner] - values[corner - 1];
  const C after = values[corner + 1] - values[corner];
  const X past = place - static_cast<double>(corner);
  if (value_of(past) >= rounded) return past * after + values[corner];
  const X value = past * before + values[corner];
  if (value_of(past) <= -rounded) return value;
  const X within = past + rounded;
  return value + within * within * ((after - before) * (0.25 / rounded));
}

/// Slope of rounded_table() per piece, and the change of that slope per piece.
template <typename X, typename C>
std::array<X, 2> rounded_table_slopes(const X& place, const std::array<C, 6>& values,
                                      double rounded) {
  const std::size_t corner = closest_corner(value_of(place));
  const C before = values[corner] - values[corner - 1];
  const C after = values[corner + 1] - values[corner];
  const X past = place - static_cast<double>(corner);
  if (value_of(past) >= rounded) return {X(after), X(0.0)};
  if (value_of(past) <= -rounded) return {X(before), X(0.0)};
  const C bend = (after - before) * (0.5 / rounded);
  return {(past + rounded) * bend + before, X(bend)};
}

/// Load from a table over the travel [N]: rounded_table() with corners of a quarter of a piece.
///
/// @param from_m, to_m  x at the first and at the last value, to_m > from_m
/// @param load_n        load at from_m, at 20, 40, 60 and 80 % of the way, and at to_m
template <typename X, typename C>
X table_load(const X& x, const C& from_m, const C& to_m, const std::array<C, 6>& load_n) {
  constexpr double kRounded = 0.25;
  return rounded_table(X((x - from_m) * (kTablePieces / (to_m - from_m))), load_n, kRounded);
}

/// Opening of a metering edge that leaks while it is covered: c + y if it is open, c^2 / (c - y) if
/// it is covered, so that the leak decays as the overlap increases. Value and slope are continuous.
///
/// @param y  spool travel from the point at which the land's edge meets the port's, positive when
///           open
/// @param c  opening at y = 0, > 0, in the unit of y
/// @source   B. Eryilmaz and B. H. Wilson, Unified modeling and analysis of a proportional valve,
///           J. Franklin Institute 343 (2006) 48-68, with k = 1
template <typename X, typename C>
X leaking_opening(const X& y, const C& c) {
  if (value_of(y) > 0.0) return y + c;
  return c * c / (c - y);
}

/// Opening of the single orifice that is equivalent to an edge in series with a fixed orifice:
/// 1 / o^2 = 1 / y^2 + 1 / l^2.
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
/// @param head_pa      P, across orifice and line together
/// @param conductance  G, orifice flow per square root of pressure, >= 0
/// @param resistance   R of the line [Pa s/m3], >= 0
template <typename X, typename C>
X flow_before_line(const X& head_pa, const X& conductance, const C& resistance,
                   const C& smoothing_pa) {
  using std::sqrt;
  const X line = conductance * resistance;
  const X size_pa = sqrt(X(head_pa * head_pa + smoothing_pa * smoothing_pa));
  return 2.0 * conductance * head_pa / (line + sqrt(X(line * line + 4.0 * size_pa)));
}

/// Opening that follows a power law, y_r (y / y_r)^n, for example that of an edge with notches.
///
/// @param y        signal beyond the dead band, > 0
/// @param range    y_r, signal at which the opening is the same as with n = 1, in the unit of y
/// @param exponent n >= 1
template <typename X, typename C>
X power_opening(const X& y, const C& range, const C& exponent) {
  using std::exp;
  using std::log;
  return exp(X(log(X(y / range)) * exponent)) * range;
}

/// Opening from a table, for example for an edge with notches or a flow curve from a data sheet. It
/// interpolates linearly between 0, the values at 20, 40, 60 and 80 % of the range, and 1 at the
/// full range, and extrapolates the last piece.
///
/// @param y       signal beyond the dead band, >= 0
/// @param range   y_r, signal at which the opening is y_r, in the unit of y
/// @param shares  openings at 20, 40, 60 and 80 % of the range, relative to the opening at the full
///                range
template <typename X, typename C>
X table_opening(const X& y, const C& range, const std::array<C, 4>& shares) {
  constexpr double kPieces = 5.0;
  const X place = y * (kPieces / range);
  const auto piece = static_cast<std::size_t>(std::clamp(value_of(place), 0.0, kPieces - 1.0));
  const C from = piece == 0 ? C(0.0) : shares[piece - 1];
  const C to = piece == shares.size() ? C(1.0) : shares[piece];
  return ((place - static_cast<double>(piece)) * (to - from) + from) * range;
}

/// Pressure across an edge behind a compensator [Pa]. The compensator throttles any excess over the
/// pressure of its spring, so that the flow no longer depends on the load. Below the spring
/// pressure it is fully open.
template <typename X, typename C>
X compensated_head(const X& head_pa, const C& spring_pa) {
  return value_of(head_pa) > value_of(spring_pa) ? X(spring_pa) : head_pa;
}

/// Largest flow of a pump, which changes smoothly from one value to another [m3/s]:
/// Q_1 + (Q_2 - Q_1) (1 + tanh((t - T_2) / tau_2)) / 2.
///
/// @param demand_s  t, how long the valve has demanded flow from the pump
template <typename X, typename C>
X two_stages(const X& demand_s, const X& first, const C& second, const C& delay_s,
             const C& rise_s) {
  using std::tanh;
  return (tanh(X((demand_s - delay_s) / rise_s)) + 1.0) * (0.5 * (second - first)) + first;
}

/// Force of an end stop on the piston [N], directed away from the stop: k d (1 + lambda d'). It
/// never pulls.
///
/// @param depth_m     d, penetration of the piston into the stop; no force if negative
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

/// Absolute pressure [Pa] for a pressure relative to the atmosphere; at least 1 kPa.
template <typename X>
X absolute_pressure(const X& pressure_pa) {
  constexpr double kLeast_pa = 1e3;
  return at_least(X(pressure_pa + kAtmosphere_pa), kLeast_pa);
}

/// Oil that an accumulator takes up per pressure [m3/Pa]. Above the precharge, its gas follows
/// p V^n = constant: V_0 / (n p) (p_g / p)^(1/n). Below the precharge, the bladder fills its shell.
/// The transition extends over a few per cent of the precharge, which keeps the derivative
/// continuous.
///
/// @param pressure_pa   above atmosphere
/// @param volume_m3     V_0, volume of the gas at the precharge
/// @param precharge_pa  p_g, above atmosphere
/// @source   D. R. Otis and A. Pourmovahed, An algorithm for computing nonflow gas processes in gas
///           springs and hydropneumatic accumulators, J. Dyn. Sys. Meas. Control 107 (1985) 93-96;
///           here with a single exponent instead of their heat transfer
template <typename X, typename C>
X accumulator_capacity(const X& pressure_pa, const C& volume_m3, const C& precharge_pa,
                       const C& exponent) {
  using std::exp;
  using std::log;
  using std::tanh;
  constexpr double kLift = 0.02;  // fraction of the precharge
  const X p = absolute_pressure(pressure_pa);
  const C first = absolute_pressure(precharge_pa);
  const X above = (tanh(X((p - first) / (first * kLift))) + 1.0) * 0.5;
  return above * exp(X(log(X(first / p)) / exponent)) * volume_m3 / (p * exponent);
}

/// Change of pressure, counted from its last reversal, after which a hose begins to yield [Pa]. Dry
/// friction locks the threads of the braid, and grows with the pressure that presses them together.
///
/// @param constant_pa  constant component
/// @param ratio        ratio of the other component to the absolute pressure
/// @source   B. Tondu and P. Lopez, Modeling and control of McKibben artificial muscle robot
///           actuators, IEEE Control Systems Magazine 20 (2000) 2, 15-38: the thread's friction
template <typename X, typename C>
X hose_yield(const X& pressure_pa, const C& constant_pa, const C& ratio) {
  return absolute_pressure(pressure_pa) * ratio + constant_pa;
}

/// Fraction of a braided hose that yields to a change of pressure: zero when the pressure reverses,
/// one after a long change in one direction.
///
/// @param memory  z, from -1 (yielded to falling pressure) to 1 (yielded to rising pressure); its
///                rate is z' = (1 - share) p' / hose_yield()
/// @param rises   whether the pressure rises now
/// @source   a Bouc-Wen operator: Y.-K. Wen, Method for random vibration of hysteretic systems, J.
///           Engineering Mechanics Division 102 (1976) 249-263; the exponent 2 is from the records
///           in docs/festo.md
template <typename X>
X yielding_share(const X& memory, bool rises) {
  const X along = rises ? X(memory) : X(-memory);
  const X half = positive_part(X(0.5 * along + 0.5));
  return value_of(half) < 1.0 ? X(half * half) : X(half * 0.0 + 1.0);
}

/// Bulk modulus of oil with undissolved air [Pa]. The air is compressed polytropically, the oil at
/// its own modulus.
///
///   beta = (1 - a + a r) / ((1 - a) / beta_l + a r / (n p)),  r = (p_0 / p)^(1/n)
///
/// @param pressure_pa   above atmosphere; constant below 1 kPa absolute
/// @param air_fraction  a, volume fraction at atmospheric pressure p_0
/// @source   H. Gholizadeh, R. Burton and G. Schoenau, Fluid bulk modulus: a literature survey,
///           Int. J. Fluid Power 12 (2011) 5-15: the compression-only model
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
