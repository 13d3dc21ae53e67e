#pragma once

#include <array>

#include "model/layout.hpp"
#include "model/parameter_values.hpp"
#include "model/terms.hpp"

namespace rigcal::model {

/// What acts on a plant at one instant; X carries time derivatives where they are wanted.
template <typename X>
struct PlantInput {
  X spool_command_v{};     ///< valve signal after its dynamics [V]
  X external_force_n{};    ///< recorded load against positive travel [N]
  X supply_pressure_pa{};  ///< P_s [Pa]
};

/// The paper's plant: piston and load pressure of a symmetric cylinder of constant volume.
///
///   m x''  = A P_L - b x' - k x - F_dry(x') - F_ext                    eq. 12
///   P_L'   = (4 beta / V_t) (Q_L - Q_leak - A x')                      eq. 13
///
/// A plant is a parameter table (`Parameters`), a right-hand side and its outputs.
struct LoadPressurePlant {
  static constexpr int kStates = 3;
  enum State { position, velocity, load_pressure };
  template <typename T>
  using Parameters = LoadPressureParameters<T>;
  template <typename T>
  static constexpr const auto& fields() {
    return kLoadPressureFields<T>;
  }
  /// Size below which a state counts as zero in the error control [m, m/s, Pa].
  static constexpr std::array<double, kStates> kFloor{1e-6, 1e-5, 100.0};

  /// Spool travel [m], eq. 6: x_v = k_sv u, after null shift and overlap.
  template <typename X, typename C>
  static X spool(const PlantInput<X>& in, const Parameters<C>& p) {
    return p.valve_gain_m_per_v *
           dead_band(X(in.spool_command_v + p.valve_offset_v), p.valve_dead_band_v);
  }

  /// Flow of the servo valve to the load [m3/s], eq. 4, less the loss across its null.
  template <typename X, typename C>
  static X servo_flow(const X& P_L, const PlantInput<X>& in, const Parameters<C>& p) {
    return model::servo_flow(spool(in, p), P_L, in.supply_pressure_pa, p.discharge_coefficient,
                             p.area_gradient_m, p.density_kg_per_m3, p.leakage_smoothing_pa) -
           P_L * p.valve_null_leakage_m3_per_s_pa;
  }

  /// Internal leakage across the piston [m3/s]: orifice (eq. 11) and laminar path.
  template <typename X, typename C>
  static X leakage_flow(const X& P_L, const Parameters<C>& p, const PresentTerms& terms) {
    const X laminar = P_L * p.laminar_leakage_m3_per_s_pa;
    if (!terms.orifice_leak) return laminar;
    return laminar + orifice_leakage(P_L, p.leakage_coefficient, p.leakage_area_m2,
                                     p.density_kg_per_m3, p.leakage_smoothing_pa);
  }

  /// Dry friction of piston and rod [N].
  template <typename X, typename C>
  static X friction(const X& v, const Parameters<C>& p, const PresentTerms& terms) {
    if (!terms.friction) return X(0.0);
    if (!terms.stribeck) return p.coulomb_friction_n * smooth_sign(v, p.friction_smoothing_m_per_s);
    return dry_friction(v, p.coulomb_friction_n, p.stribeck_friction_n, p.stribeck_velocity_m_per_s,
                        p.friction_smoothing_m_per_s);
  }

  /// Time derivative of the state [m/s, m/s2, Pa/s].
  template <typename X, typename C>
  static std::array<X, kStates> derivative(const std::array<X, kStates>& x, const PlantInput<X>& in,
                                           const Parameters<C>& p, const PresentTerms& terms) {
    const X& v = x[velocity];
    const X& P_L = x[load_pressure];
    const C& A = p.piston_area_m2;
    const X force = P_L * A - v * p.damping_n_s_per_m - x[position] * p.stiffness_n_per_m -
                    friction(v, p, terms) - in.external_force_n - p.external_force_n;
    const X flow = servo_flow(P_L, in, p) - leakage_flow(P_L, p, terms) - v * A;
    const C stiffness = 4.0 * p.bulk_modulus_pa / p.total_volume_m3;
    return {v, force / p.mass_kg, flow * stiffness};
  }

  /// What a load cell in the rod reads: the force that the rod passes to mass, damper and spring of
  /// the load, A P_L less the dry friction of the cylinder (docs/model.md).
  template <typename C>
  static C rod_force(const std::array<C, kStates>& x, const Parameters<C>& p,
                     const PresentTerms& terms) {
    return x[load_pressure] * p.piston_area_m2 - friction(x[velocity], p, terms);
  }

  /// Initial state: recorded position and load pressure less the offsets of their sensors; where no
  /// initial load pressure is given, the one that holds load and spring in equilibrium.
  template <typename C>
  static std::array<C, kStates> initial(const Parameters<C>& p, bool pressure_given) {
    const C x = p.initial_position_m - p.position_offset_m;
    const C P_L = pressure_given
                      ? C(p.initial_load_pressure_pa - p.load_pressure_offset_pa)
                      : C((p.external_force_n + p.stiffness_n_per_m * x) / p.piston_area_m2);
    return {x, p.initial_velocity_m_per_s, P_L};
  }
};

}  // namespace rigcal::model
