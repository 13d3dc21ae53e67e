#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "model/plant/chambers.hpp"
#include "model/plant/plant_input.hpp"
#include "model/plant/terms.hpp"
#include "model/plant/two_chamber_parameters.hpp"

namespace rigcal::model {

/// Piston and both chamber pressures of a cylinder that is driven by a valve with four metering
/// edges.
///
///   m v'  = A_A p_A - A_B p_B - b v - k x - F_dry(v) + F_stops - (m + m_2) g - F_ext(x)
///           - m_2 x_2''
///   p_A'  = beta(p_A) / V_A (Q_A - Q_leak - G_A (p_A - P_t) - A_A v)
///   p_B'  = beta(p_B) / V_B (Q_leak - Q_B - G_B (p_B - P_t) + A_B v)
///   V_A   = V_A0 + A_A (x - x_R),  V_B = V_B0 + A_B (x_R + H - x)
///
/// Q_A flows from the valve into chamber A, Q_B from chamber B into the valve.
struct TwoChamberPlant : Chambers {
  static constexpr std::string_view kName = "two_chamber";  ///< in campaign files
  static constexpr bool kHoses = true;  ///< its hoses may yield: hose_rates(), hose_memory()
  enum Motion { position, velocity };
  template <typename T>
  using Parameters = TwoChamberParameters<T>;
  /// Parameters and quantities that depend only on them.
  template <typename C>
  struct Coefficients : ChamberCoefficients<Parameters<C>> {
    C inverse_mass{};  ///< [1/kg]

    Coefficients() = default;
    explicit Coefficients(const Parameters<C>& p)
        : ChamberCoefficients<Parameters<C>>(p), inverse_mass(1.0 / p.mass_kg) {}
  };
  template <typename T>
  static constexpr const auto& fields() {
    return kTwoChamberFields<T>;
  }
  static constexpr std::array<StateRow, kStates> kStateRows{kPistonPosition, kPistonVelocity,
                                                            kPressureA, kPressureB};

  /// Index of the state that an output equals, apart from sensor errors; std::nullopt if the output
  /// depends on more than one state.
  static constexpr std::optional<int> state_of(Output output) {
    if (output == Output::position) return position;
    if (output == Output::velocity) return velocity;
    return pressure_of(output);
  }

  /// No output is reversible, because the chambers differ.
  static bool reversible(Output, const PresentTerms&) { return false; }

  /// Spool travel [m], eq. 6, with null shift. The overlaps are applied to the edges.
  template <typename X, typename C>
  static X spool(const PlantInput<X>& in, const Coefficients<C>& p, const PresentTerms& terms) {
    if (terms.shaped_valve) return shaped_spool(in, p, terms);
    return p.valve_gain_m_per_v * (in.spool_command_v + p.valve_offset_v);
  }

  /// Flow through one edge [m3/s]: its orifice plus the laminar leak through its clearance. A
  /// positive spool signal [V] opens the edge.
  template <typename X, typename C>
  static X edge(const X& signal_v, const C& gain, const C& overlap_v, const X& up_pa,
                const X& down_pa, const Coefficients<C>& p, const PresentTerms& terms) {
    const X travel_v = signal_v - p.valve_dead_band_v - overlap_v;
    if (!terms.null_opening && !(value_of(travel_v) > 0.0))  // covered, as two of four always are
      return terms.null_leak ? (up_pa - down_pa) * p.valve_null_leakage_m3_per_s_pa : X(0.0);
    X opening_v = terms.null_opening ? leaking_opening(travel_v, p.valve_null_opening_v) : travel_v;
    if (terms.line_loss) opening_v = series_opening(opening_v, p.valve_line_opening_v);
    const X head_pa = up_pa - down_pa;
    const X orifice =
        opening_v * (gain * p.edge_conductance) * signed_sqrt(head_pa, p.leakage_smoothing_pa);
    if (!terms.null_leak) return orifice;
    return orifice + head_pa * p.valve_null_leakage_m3_per_s_pa;
  }

  template <typename X, std::size_t M, typename C>
  static ValveFlows<X> valve_flows(const std::array<X, M>& x, const PlantInput<X>& in,
                                   const Coefficients<C>& p, const PresentTerms& terms) {
    if (terms.shaped_valve) return flows_of_shape(x, in, p, terms);
    const X out = in.spool_command_v + p.valve_offset_v;
    const X back = -out;
    const X &p_A = x[pressure_a], &p_B = x[pressure_b];
    const X &P_s = in.supply_pressure_pa, &P_t = in.tank_pressure_pa;
    return {edge(out, p.gain_supply_to_a, p.overlap_supply_to_a_v, P_s, p_A, p, terms),
            edge(back, p.gain_a_to_tank, p.overlap_a_to_tank_v, p_A, P_t, p, terms),
            edge(back, p.gain_supply_to_b, p.overlap_supply_to_b_v, P_s, p_B, p, terms),
            edge(out, p.gain_b_to_tank, p.overlap_b_to_tank_v, p_B, P_t, p, terms)};
  }

  /// Not inlined, to keep the code of a plain valve short.
  template <typename X, std::size_t M, typename C>
  [[gnu::noinline]] static ValveFlows<X> flows_of_shape(const std::array<X, M>& x,
                                                        const PlantInput<X>& in,
                                                        const Coefficients<C>& p,
                                                        const PresentTerms& terms) {
    return shaped_valve_flows(x, in, p, terms);
  }

  /// Flow that the valve takes from the supply [m3/s].
  template <typename X, std::size_t M, typename C>
  static X supply_flow(const std::array<X, M>& x, const PlantInput<X>& in, const Coefficients<C>& p,
                       const PresentTerms& terms) {
    const ValveFlows<X> q = valve_flows(x, in, p, terms);
    return q.supply_to_a + q.supply_to_b;
  }

  template <typename X, std::size_t M, typename C>
  static const X& piston_velocity(const std::array<X, M>& x, const Coefficients<C>& /*p*/) {
    return x[velocity];
  }

  /// Force of both stops on the piston, positive outwards [N].
  template <typename X, typename C>
  static X stops_force(const X& x, const X& v, const Coefficients<C>& p,
                       const PresentTerms& terms) {
    const C retracted = retracted_stop(p, terms);
    return stop_force(X(retracted - x), X(-v), p.stop_stiffness_n_per_m, p.stop_damping_s_per_m) -
           stop_force(X(x - retracted - p.stroke_m), v, p.stop_stiffness_n_per_m,
                      p.stop_damping_s_per_m);
  }

  template <typename C>
  static C retracted_stop(const Coefficients<C>& p, const PresentTerms& terms) {
    return terms.retracted_position ? p.retracted_position_m : C(-0.5 * p.stroke_m);
  }

  /// Oil volumes of the chambers [m3]. They are at least a thousandth of the swept volume, even if
  /// the piston is pressed into a stop.
  template <typename X, typename C>
  static std::array<X, 2> volumes(const X& x, const Coefficients<C>& p, const PresentTerms& terms) {
    const X extended = x - retracted_stop(p, terms);
    return {at_least(X(extended * p.area_a_m2 + p.dead_volume_a_m3),
                     1e-3 * value_of(p.area_a_m2) * value_of(p.stroke_m)),
            at_least(X((p.stroke_m - extended) * p.area_b_m2 + p.dead_volume_b_m3),
                     1e-3 * value_of(p.area_b_m2) * value_of(p.stroke_m))};
  }

  /// Time derivative of the state [m/s, m/s2, Pa/s, Pa/s].
  template <typename X, std::size_t M, typename C>
  static std::array<X, kStates> derivative(const std::array<X, M>& x, const PlantInput<X>& in,
                                           const Coefficients<C>& p, const PresentTerms& terms) {
    const X& v = x[velocity];
    X force = piston_force(x, p) - v * p.damping_n_s_per_m - x[position] * p.stiffness_n_per_m +
              stops_force(x[position], v, p, terms) - p.mass_kg * p.gravity_m_per_s2;
    if (terms.friction) force = force - friction_of<TwoChamberPlant>(x, p, terms);
    if (terms.external_load || terms.varying_load)
      force = force - external_load(x[position], in, p, terms);
    if constexpr (M > kStates + 1) {
      if (terms.payload >= 0)
        force = force - (payload_acceleration(x, position, terms, p) + p.gravity_m_per_s2) *
                            p.payload_mass_kg;
    }
    const auto flow = chamber_flows(x, v, valve_flows(x, in, p, terms), in, p, terms);
    const auto volume = volumes(x[position], p, terms);
    const X take_a = volume[0] / bulk_modulus(x[pressure_a], p, terms);
    const X take_b = volume[1] / bulk_modulus(x[pressure_b], p, terms);
    const auto yields = hose_shares(x, flow[0], flow[1], terms);
    return {v, force * p.inverse_mass, flow[0] / (take_a + yields[0] * p.hose_capacity_a_m3_per_pa),
            flow[1] / (take_b + yields[1] * p.hose_capacity_b_m3_per_pa)};
  }

  /// Fraction of each hose that yields. The sign of the flow into a chamber gives the direction in
  /// which its pressure changes.
  template <typename X, std::size_t M>
  static std::array<X, 2> hose_shares(const std::array<X, M>& x, const X& toward_a,
                                      const X& toward_b, const PresentTerms& terms) {
    if constexpr (M > kStates + 1) {
      if (terms.hoses >= 0) {
        const auto first = static_cast<std::size_t>(terms.hoses);
        return {yielding_share(x[first], value_of(toward_a) > 0.0),
                yielding_share(x[first + 1], value_of(toward_b) > 0.0)};
      }
    }
    return {X(0.0), X(0.0)};
  }

  /// Time derivative of the hoses' memory [1/s].
  /// @param dx  derivative() of the plant
  template <typename X, std::size_t M, typename C>
  static std::array<X, 2> hose_rates(const std::array<X, M>& x, const std::array<X, kStates>& dx,
                                     const Coefficients<C>& p, const PresentTerms& terms) {
    const auto yields = hose_shares(x, dx[pressure_a], dx[pressure_b], terms);
    const X yield_a = hose_yield(x[pressure_a], p.hose_yield_pa, p.hose_yield_ratio);
    const X yield_b = hose_yield(x[pressure_b], p.hose_yield_pa, p.hose_yield_ratio);
    return {(1.0 - yields[0]) * dx[pressure_a] / yield_a,
            (1.0 - yields[1]) * dx[pressure_b] / yield_b};
  }

  /// Memory of a hose after a single monotonic change of pressure: a rise from tank pressure or a
  /// fall from supply pressure.
  template <typename X, typename C>
  static X hose_memory(const X& pressure_pa, const PlantInput<C>& in) {
    return clamp_symmetric(X((2.0 * pressure_pa - in.supply_pressure_pa - in.tank_pressure_pa) /
                             (in.supply_pressure_pa - in.tank_pressure_pa)),
                           C(1.0));
  }

  /// Outputs of the plant other than position and velocity. Servo flow and work flow are means over
  /// both chambers: Q_L = (Q_A + Q_B) / 2.
  template <typename X, std::size_t M, typename C>
  static X output(Output output, const std::array<X, M>& x, const PlantInput<X>& in,
                  const Coefficients<C>& p, const PresentTerms& terms) {
    switch (output) {
      case Output::load_pressure:
        return x[pressure_a] - x[pressure_b];
      case Output::pressure_a:
        return x[pressure_a];
      case Output::pressure_b:
        return x[pressure_b];
      case Output::force:
        return piston_force(x, p) - friction_of<TwoChamberPlant>(x, p, terms) +
               stops_force(x[position], x[velocity], p, terms);
      case Output::spool:
        return spool(in, p, terms);
      case Output::servo_flow:
        return servo_flow(valve_flows(x, in, p, terms));
      case Output::leakage_flow:
        return leakage_flow(x, p, terms);
      case Output::work_flow:
        return x[velocity] * (0.5 * (p.area_a_m2 + p.area_b_m2));
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

  /// State at rest: at x = 0, or at the closer stop if that is out of reach. The pressures balance
  /// the load, and their sum is that of supply and tank pressure.
  template <typename C>
  static std::array<C, kStates> rest(const PlantInput<C>& in, const Coefficients<C>& p,
                                     const PresentTerms& terms) {
    return settled({C(0.0), C(0.0), C(0.0), C(0.0)}, in, p, terms, false, false);
  }

  /// Initial state from those sensor readings that were given. Missing pressures balance the load.
  template <typename C>
  static std::array<C, kStates> initial(const PlantInput<C>& in, const Coefficients<C>& p,
                                        const PresentTerms& terms) {
    return settled({C((p.initial_position_m - p.position_offset_m) / p.position_gain),
                    p.initial_velocity_m_per_s,
                    C((p.initial_pressure_a_pa - p.pressure_a_offset_pa) / p.pressure_a_gain),
                    C((p.initial_pressure_b_pa - p.pressure_b_offset_pa) / p.pressure_b_gain)},
                   in, p, terms, terms.initial_pressure_a, terms.initial_pressure_b);
  }

 private:
  /// Fills in the pressures that are not given. If the reading puts the piston beyond a stop, moves
  /// it onto the stop, because a sensor's error can exceed the elastic travel of a stop.
  template <typename C>
  static std::array<C, kStates> settled(std::array<C, kStates> x, const PlantInput<C>& in,
                                        const Coefficients<C>& p, const PresentTerms& terms,
                                        bool given_a, bool given_b) {
    C load = p.mass_kg * p.gravity_m_per_s2 + p.stiffness_n_per_m * x[position];
    if (terms.payload >= 0) load = load + p.payload_mass_kg * p.gravity_m_per_s2;
    load = load + external_load(x[position], in, p, terms);
    const C &A = p.area_a_m2, &B = p.area_b_m2;
    if (!given_a && !given_b) {
      x[pressure_a] = (B * (in.supply_pressure_pa + in.tank_pressure_pa) + load) / (A + B);
      given_a = true;
    }
    if (!given_a) x[pressure_a] = (B * x[pressure_b] + load) / A;
    if (!given_b) x[pressure_b] = (A * x[pressure_a] - load) / B;
    const C push = A * x[pressure_a] - B * x[pressure_b] - load;
    const C depth = push / p.stop_stiffness_n_per_m;
    const C retracted = retracted_stop(p, terms);
    const C extended = retracted + p.stroke_m;
    if (value_of(x[position]) <= value_of(retracted)) {
      x[position] = value_of(push) < 0.0 ? retracted + depth : retracted;
      x[velocity] = C(0.0);
    } else if (value_of(x[position]) >= value_of(extended)) {
      x[position] = value_of(push) > 0.0 ? extended + depth : extended;
      x[velocity] = C(0.0);
    }
    return x;
  }
};

}  // namespace rigcal::model
