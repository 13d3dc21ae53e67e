#pragma once

#include <array>
#include <cstddef>

#include "model/plant/layout.hpp"
#include "model/plant/parameter_values.hpp"
#include "model/plant/terms.hpp"

namespace rigcal::model {

/// Inputs of a plant at one instant. X includes time derivatives if they are needed.
template <typename X>
struct PlantInput {
  X spool_command_v;  ///< valve signal after its dynamics [V]
  /// Load against positive travel [N], or against positive angle of a joint [N m]; set only if the
  /// model has that term.
  X external_load;
  X supply_pressure_pa;  ///< P_s [Pa]
  X tank_pressure_pa;    ///< P_t [Pa]; set only if the plant has a tank
};

/// Dry friction of piston and rod [N]; zero unless it was given.
template <typename X, typename C>
X friction(const X& v, const CommonParameters<C>& p, const PresentTerms& terms) {
  if (!terms.friction) return X(0.0);
  if (!terms.stribeck) return p.coulomb_friction_n * smooth_sign(v, p.friction_smoothing_m_per_s);
  return dry_friction(v, p.coulomb_friction_n, p.stribeck_friction_n, p.stribeck_velocity_m_per_s,
                      p.friction_smoothing_m_per_s);
}

/// Internal leakage across the piston from A to B [m3/s]: an orifice (eq. 11), in series with a
/// laminar resistance if that was given, and a laminar path in parallel.
///
/// @param p  parameters of the plant, with orifice_conductance() of the leak as leak_conductance
template <typename X, typename P>
X internal_leak(const X& load_pressure_pa, const P& p, const PresentTerms& terms) {
  const X laminar = load_pressure_pa * p.laminar_leakage_m3_per_s_pa;
  if (!terms.orifice_leak) return laminar;
  if (terms.leak_line)
    return laminar + flow_before_line(load_pressure_pa, X(p.leak_conductance),
                                      p.leakage_resistance_pa_s_per_m3, p.leakage_smoothing_pa);
  return laminar + orifice_leakage(load_pressure_pa, p.leak_conductance, p.leakage_smoothing_pa);
}

/// Flow from the source to the valve that keeps a pressure at the pump [m3/s].
template <typename X, typename C>
X asked_flow(const X& kept_pa, const PlantInput<X>& in, const CommonParameters<C>& p) {
  return (kept_pa - in.supply_pressure_pa) / p.supply_resistance_pa_s_per_m3;
}

/// Time derivative of the supply pressure at the valve [Pa/s], where oil and accumulator take up a
/// flow.
///
/// @param flow  of the pump, less what the valve takes [m3/s]
template <typename X, typename C>
X supply_rise(const X& flow, const PlantInput<X>& in, const CommonParameters<C>& p,
              const PresentTerms& terms) {
  if (!terms.accumulator) return flow / p.supply_capacity_m3_per_pa;
  return flow / (accumulator_capacity(in.supply_pressure_pa, p.accumulator_volume_m3,
                                      p.accumulator_precharge_pa, p.accumulator_exponent) +
                 p.supply_capacity_m3_per_pa);
}

/// Flow through the relief valve of a chamber to the tank [m3/s].
template <typename X, typename C>
X relief_flow(const X& chamber_pa, const CommonParameters<C>& p) {
  return positive_part(X(chamber_pa - p.relief_pressure_pa)) * p.relief_conductance_m3_per_s_pa;
}

/// Sliding friction where the part above Coulomb's fades with the film [N]. Not inlined, to keep
/// the code of rigs without a film short.
template <typename X, typename C>
[[gnu::noinline]] X lubricated(const X& sliding_n, const X& film, const CommonParameters<C>& p) {
  return (sliding_n - p.coulomb_friction_n) * (1.0 - film) + p.coulomb_friction_n;
}

/// Time derivative of the relative thickness of the lubricant film [1/s].
///
/// @tparam Plant  provides the velocity of the piston
template <typename Plant, typename X, std::size_t M, typename P>
[[gnu::noinline]] X film_rate_of(const std::array<X, M>& x, const P& p, const PresentTerms& terms) {
  const X& film = x[static_cast<std::size_t>(terms.film)];
  const X& v = Plant::piston_velocity(x, p);
  const X steady = steady_film(v, p.film_velocity_m_per_s, p.friction_smoothing_m_per_s);
  const bool grows = value_of(film) < value_of(steady);
  return film_rate(film, steady, v, grows ? p.film_growth_time_s : p.film_decay_time_s,
                   p.film_dwell_time_s, p.friction_smoothing_m_per_s);
}

/// Magnitude of the dry friction while the piston slides [N]. Seal friction grows with the pressure
/// that energises the seals.
///
/// @tparam Plant  provides the velocity of the piston and the pressure across it
template <typename Plant, typename X, std::size_t M, typename P>
X sliding_friction_of(const std::array<X, M>& x, const P& p, const PresentTerms& terms) {
  const X& v = Plant::piston_velocity(x, p);
  X sliding_n = terms.stribeck ? sliding_friction(v, p.coulomb_friction_n, p.stribeck_friction_n,
                                                  p.stribeck_velocity_m_per_s)
                               : X(p.coulomb_friction_n);
  if constexpr (M > static_cast<std::size_t>(Plant::kStates)) {
    if (terms.film >= 0)
      sliding_n = lubricated(sliding_n, x[static_cast<std::size_t>(terms.film)], p);
  }
  if (!terms.seal_friction) return sliding_n;
  const X P_L = Plant::pressure_across(x);
  return sliding_n + (value_of(P_L) < 0.0 ? X(-P_L) : P_L) * p.seal_friction_m2;
}

/// Time derivative of the bristle force [N/s].
template <typename Plant, typename X, std::size_t M, typename P>
X bristle_rate_of(const std::array<X, M>& x, const P& p, const PresentTerms& terms) {
  const X& v = Plant::piston_velocity(x, p);
  return bristle_rate(x[static_cast<std::size_t>(terms.bristles)], v,
                      sliding_friction_of<Plant>(x, p, terms), p.bristle_stiffness_n_per_m);
}

/// Dry friction with seal friction or pre-sliding [N]. Not inlined, to keep the code of rigs
/// without these terms short.
template <typename Plant, typename X, std::size_t M, typename P>
[[gnu::noinline]] X shaped_friction(const std::array<X, M>& x, const P& p,
                                    const PresentTerms& terms) {
  if constexpr (M > static_cast<std::size_t>(Plant::kStates)) {
    if (terms.bristles >= 0)
      return x[static_cast<std::size_t>(terms.bristles)] +
             bristle_rate_of<Plant>(x, p, terms) *
                 (p.bristle_damping_n_s_per_m / p.bristle_stiffness_n_per_m);
  }
  const X& v = Plant::piston_velocity(x, p);
  return sliding_friction_of<Plant>(x, p, terms) * smooth_sign(v, p.friction_smoothing_m_per_s);
}

/// Dry friction of piston and rod [N], with any of the optional terms.
template <typename Plant, typename X, std::size_t M, typename P>
X friction_of(const std::array<X, M>& x, const P& p, const PresentTerms& terms) {
  if (terms.shaped_friction) return shaped_friction<Plant>(x, p, terms);
  const X& v = Plant::piston_velocity(x, p);
  return friction(v, p, terms);
}

/// Load of the table at x [N]. Not inlined, to keep the code of rigs without it short.
template <typename X, typename C>
[[gnu::noinline]] X tabled_load(const X& x, const CommonParameters<C>& p) {
  return table_load(x, p.load_table_from_m, p.load_table_to_m,
                    std::array<C, 6>{p.load_0_n, p.load_20_n, p.load_40_n, p.load_60_n, p.load_80_n,
                                     p.load_100_n});
}

/// Load that varies with the travel [N]. Not inlined, to keep the code of rigs without it short.
template <typename X, typename C>
[[gnu::noinline]] X load_by_travel(const X& x, const CommonParameters<C>& p,
                                   const PresentTerms& terms) {
  if (terms.load_table) return tabled_load(x, p);
  if (terms.curved_load) return varying_load(x, p.load_gradient_n_per_m, p.load_curvature_n_per_m2);
  return x * p.load_gradient_n_per_m;
}

/// Load against positive travel [N]: the external force plus the load that varies with the travel.
template <typename X, typename C>
X external_load(const X& x, const PlantInput<X>& in, const CommonParameters<C>& p,
                const PresentTerms& terms) {
  if (!terms.varying_load) return terms.external_load ? in.external_load : X(0.0);
  const X load = terms.external_load ? in.external_load : X(0.0);
  return load + load_by_travel(x, p, terms);
}

/// Acceleration of the second mass [m/s2].
///
/// @param position  index of the first mass's position; its velocity is the next state
template <typename X, std::size_t M, typename C>
X payload_acceleration(const std::array<X, M>& x, int position, const PresentTerms& terms,
                       const CommonParameters<C>& p) {
  const auto first = static_cast<std::size_t>(position);
  const auto second = static_cast<std::size_t>(terms.payload);
  return spring_and_damper(X(x[first] - x[second]), X(x[first + 1] - x[second + 1]),
                           p.payload_frequency_rad_per_s, p.payload_damping_ratio);
}

}  // namespace rigcal::model
