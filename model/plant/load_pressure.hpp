#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "model/plant/plant_input.hpp"
#include "model/plant/terms.hpp"

namespace rigcal::model {

/// The paper's plant: piston and load pressure of a symmetric cylinder with constant volume.
///
///   m x''  = A P_L - b x' - k x - F_dry(x') - F_ext(x) - m_2 x_2''     eq. 12
///   P_L'   = (4 beta / V_t) (Q_L - Q_leak - A x')                      eq. 13
///
/// The supply may give way. Both chambers share it equally, (P_s + P_L) / 2 and (P_s - P_L) / 2.
///
/// A plant consists of a parameter table (`Parameters`), a right-hand side and outputs.
struct LoadPressurePlant {
  static constexpr std::string_view kName = "load_pressure";  ///< in campaign files
  static constexpr int kStates = 3;
  enum State { position, velocity, load_pressure };
  template <typename T>
  using Parameters = LoadPressureParameters<T>;
  /// Parameters and quantities that depend only on them.
  template <typename C>
  struct Coefficients : Parameters<C> {
    C valve_conductance{};  ///< servo flow per spool travel and square root of pressure
    C leak_conductance{};   ///< orifice leakage per square root of pressure
    C inverse_mass{};       ///< [1/kg]
    C inverse_capacity{};   ///< pressure rate per flow, 4 beta / V_t [Pa/m3]

    Coefficients() = default;
    explicit Coefficients(const Parameters<C>& p)
        : Parameters<C>(p),
          valve_conductance(model::valve_conductance(p.discharge_coefficient, p.area_gradient_m,
                                                     p.density_kg_per_m3)),
          leak_conductance(model::orifice_conductance(p.leakage_coefficient, p.leakage_area_m2,
                                                      p.density_kg_per_m3)),
          inverse_mass(1.0 / p.mass_kg),
          inverse_capacity(4.0 * p.bulk_modulus_pa / p.total_volume_m3) {}
  };
  template <typename T>
  static constexpr const auto& fields() {
    return kLoadPressureFields<T>;
  }
  static constexpr std::array<StateRow, kStates> kStateRows{
      kPistonPosition, kPistonVelocity,
      StateRow{"load_pressure", "Pa", "pressure of chamber A minus that of B", 100.0, 0.1}};

  /// Index of the state that an output equals, apart from sensor errors; std::nullopt if the output
  /// depends on more than one state.
  static constexpr std::optional<int> state_of(Output output) {
    switch (output) {
      case Output::position:
        return position;
      case Output::velocity:
        return velocity;
      case Output::load_pressure:
        return load_pressure;
      default:
        return std::nullopt;
    }
  }

  /// Whether reversing the inputs reverses the states and this output. All terms are odd functions,
  /// except those that act in one direction only, and the lubricant film and a supply that gives
  /// way, which have no direction.
  /// The chamber pressures swap instead of changing sign.
  static bool reversible(Output output, const PresentTerms& terms) {
    return !terms.external_load && !terms.curved_load && !terms.load_table && !terms.valve_offset &&
           terms.film < 0 && terms.supply < 0 && output != Output::pressure_a &&
           output != Output::pressure_b;
  }

  /// Spool travel [m], eq. 6: x_v = k_sv u, with null shift and overlap.
  template <typename X, typename C>
  static X spool(const PlantInput<X>& in, const Coefficients<C>& p, const PresentTerms& terms) {
    if (!terms.spool_shape) return in.spool_command_v * p.valve_gain_m_per_v;
    return dead_band(X(in.spool_command_v + p.valve_offset_v), p.valve_dead_band_v) *
           p.valve_gain_m_per_v;
  }

  /// Flow of the servo valve to the load [m3/s], eq. 4, minus the leakage across its null.
  template <typename X, typename C>
  static X servo_flow(const X& P_L, const PlantInput<X>& in, const Coefficients<C>& p,
                      const PresentTerms& terms) {
    const X flow = model::servo_flow(spool(in, p, terms), P_L, in.supply_pressure_pa,
                                     p.valve_conductance, p.leakage_smoothing_pa);
    if (!terms.null_leak) return flow;
    return flow - P_L * p.valve_null_leakage_m3_per_s_pa;
  }

  /// Flow that the valve takes from the supply [m3/s]: that to the load, in the direction of the
  /// spool, and the leak of the closed edges. Not inlined, to keep the code of rigs with a constant
  /// supply short.
  template <typename X, std::size_t M, typename C>
  [[gnu::noinline]] static X supply_flow(const std::array<X, M>& x, const PlantInput<X>& in,
                                         const Coefficients<C>& p, const PresentTerms& terms) {
    const X travel_m = spool(in, p, terms);
    const X flow = model::servo_flow(travel_m, x[load_pressure], in.supply_pressure_pa,
                                     p.valve_conductance, p.leakage_smoothing_pa);
    const X taken = value_of(travel_m) < 0.0 ? X(-flow) : flow;
    if (!terms.null_leak) return taken;
    return taken + in.supply_pressure_pa * p.valve_null_leakage_m3_per_s_pa;
  }

  /// Time derivative of the supply pressure at the valve [Pa/s].
  ///
  /// @param limit_pa  pressure to which the pump is limited
  /// @param taken     flow that the valve takes from the supply [m3/s]
  template <typename X, std::size_t M, typename C>
  [[gnu::noinline]] static X supply_rate(const X& limit_pa, const X& taken,
                                         const std::array<X, M>& /*x*/, const PlantInput<X>& in,
                                         const Coefficients<C>& p, const PresentTerms& terms) {
    X flow = asked_flow(limit_pa, in, p);
    if (terms.pump_flow && value_of(flow) > value_of(p.pump_flow_m3_per_s))
      flow = X(p.pump_flow_m3_per_s);
    return supply_rise(X(flow - taken), in, p, terms);
  }

  /// Servo flow that the relief valves of both chambers take from the load [m3/s]. Not inlined, to
  /// keep the code of rigs without them short.
  template <typename X, typename C>
  [[gnu::noinline]] static X relieved_flow(const X& P_L, const PlantInput<X>& in,
                                           const Coefficients<C>& p) {
    const X& P_s = in.supply_pressure_pa;
    return (relief_flow(X((P_s + P_L) * 0.5), p) - relief_flow(X((P_s - P_L) * 0.5), p)) * 0.5;
  }

  /// Internal leakage across the piston [m3/s]: an orifice (eq. 11) and a laminar path.
  template <typename X, typename C>
  static X leakage_flow(const X& P_L, const Coefficients<C>& p, const PresentTerms& terms) {
    if (!terms.laminar_leak && !terms.leak_line)
      return terms.orifice_leak ? orifice_leakage(P_L, p.leak_conductance, p.leakage_smoothing_pa)
                                : X(0.0);
    return internal_leak(P_L, p, terms);
  }

  template <typename X, std::size_t M>
  static X pressure_across(const std::array<X, M>& x) {
    return x[load_pressure];
  }

  template <typename X, std::size_t M, typename C>
  static const X& piston_velocity(const std::array<X, M>& x, const Coefficients<C>& /*p*/) {
    return x[velocity];
  }

  /// Time derivative of the state [m/s, m/s2, Pa/s].
  ///
  /// @param x  shape (kStates or more): the plant's states come first
  template <typename X, std::size_t M, typename C>
  static std::array<X, kStates> derivative(const std::array<X, M>& x, const PlantInput<X>& in,
                                           const Coefficients<C>& p, const PresentTerms& terms) {
    const X& v = x[velocity];
    const X& P_L = x[load_pressure];
    const C& A = p.piston_area_m2;
    X force = P_L * A - v * p.damping_n_s_per_m - x[position] * p.stiffness_n_per_m;
    if (terms.friction) force = force - friction_of<LoadPressurePlant>(x, p, terms);
    if (terms.external_load || terms.varying_load)
      force = force - external_load(x[position], in, p, terms);
    if constexpr (M > kStates + 1) {
      if (terms.payload >= 0)
        force = force - payload_acceleration(x, position, terms, p) * p.payload_mass_kg;
    }
    X flow = servo_flow(P_L, in, p, terms) - leakage_flow(P_L, p, terms) - v * A;
    if (terms.relief) flow = flow - relieved_flow(P_L, in, p);
    return {v, force * p.inverse_mass, flow * p.inverse_capacity};
  }

  /// Outputs of the plant other than position and velocity. Its chambers share the load pressure
  /// equally. `force` is the reading of a load cell in the rod: the force that the rod transmits to
  /// mass, damper and spring of the load, A P_L minus the dry friction of the cylinder
  /// (docs/model.md).
  template <typename X, std::size_t M, typename C>
  static X output(Output output, const std::array<X, M>& x, const PlantInput<X>& in,
                  const Coefficients<C>& p, const PresentTerms& terms) {
    const X& P_L = x[load_pressure];
    switch (output) {
      case Output::load_pressure:
        return P_L;
      case Output::pressure_a:
        return 0.5 * (in.supply_pressure_pa + P_L);
      case Output::pressure_b:
        return 0.5 * (in.supply_pressure_pa - P_L);
      case Output::force:
        return P_L * p.piston_area_m2 - friction_of<LoadPressurePlant>(x, p, terms);
      case Output::spool:
        return spool(in, p, terms);
      case Output::servo_flow:
        return servo_flow(P_L, in, p, terms);
      case Output::leakage_flow:
        return leakage_flow(P_L, p, terms);
      case Output::work_flow:
        return x[velocity] * p.piston_area_m2;
      case Output::position:
      case Output::velocity:
      case Output::acceleration:
      case Output::payload_acceleration:
      case Output::angle:
      case Output::angular_velocity:
      case Output::torque:
      case Output::pilot_pressure:
      case Output::command:
        break;
    }
    return X(0.0);
  }

  /// State at rest: all zero.
  template <typename C>
  static std::array<C, kStates> rest(const PlantInput<C>& /*in*/, const Coefficients<C>& /*p*/,
                                     const PresentTerms& /*terms*/) {
    return {C(0.0), C(0.0), C(0.0)};
  }

  /// Initial state: recorded position and load pressure, corrected for sensor errors. A load
  /// pressure that was not given balances spring and load, a recorded one too.
  template <typename C>
  static std::array<C, kStates> initial(const PlantInput<C>& in, const Coefficients<C>& p,
                                        const PresentTerms& terms) {
    const C load = terms.external_load ? in.external_load : C(0.0);
    const C x = (p.initial_position_m - p.position_offset_m) / p.position_gain;
    C P_L = terms.initial_load_pressure
                ? C((p.initial_load_pressure_pa - p.load_pressure_offset_pa) / p.load_pressure_gain)
                : C((load + p.stiffness_n_per_m * x +
                     varying_load(x, p.load_gradient_n_per_m, p.load_curvature_n_per_m2)) /
                    p.piston_area_m2);
    if (terms.load_table && !terms.initial_load_pressure)
      P_L = P_L + tabled_load(x, p) / p.piston_area_m2;
    return {x, p.initial_velocity_m_per_s, P_L};
  }
};

}  // namespace rigcal::model
