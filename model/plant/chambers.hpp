#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "model/plant/plant_input.hpp"
#include "model/plant/terms.hpp"
#include "model/plant/two_chamber_parameters.hpp"

namespace rigcal::model {

/// Parameters of a cylinder with two chambers, and quantities that depend only on them.
///
/// @tparam Parameters  parameters of the plant, with the members of TwoChamberParameters
template <typename Parameters>
struct ChamberCoefficients : Parameters {
  using C = decltype(Parameters::area_a_m2);
  C gain{};  ///< spool travel per signal, of an electric or a pilot-operated valve [m/V or m/Pa]
  C dead_band{};         ///< [V or Pa]
  C conductance{};       ///< flow through an edge per spool travel and square root of pressure
  C edge_conductance{};  ///< flow through an edge per signal and square root of pressure
  C leak_conductance{};  ///< orifice leakage per square root of pressure

  ChamberCoefficients() = default;
  explicit ChamberCoefficients(const Parameters& p)
      : Parameters(p),
        gain(p.valve_gain_m_per_v + p.pilot_gain_m_per_pa),  // one of the two is zero
        dead_band(p.valve_dead_band_v + p.pilot_dead_band_pa),
        conductance(
            orifice_conductance(p.discharge_coefficient, p.area_gradient_m, p.density_kg_per_m3)),
        edge_conductance(conductance * gain),
        leak_conductance(
            orifice_conductance(p.leakage_coefficient, p.leakage_area_m2, p.density_kg_per_m3)) {}
};

/// The hydraulics of a cylinder with two chambers: pump, valve with four metering edges, leaks and
/// chambers. Plants that differ in the load of the piston derive from it.
struct Chambers {
  static constexpr int kStates = 4;  ///< position and velocity of the load, then both pressures
  enum Pressure { pressure_a = 2, pressure_b = 3 };

  /// Index of the state that an output equals, apart from sensor errors; std::nullopt if the output
  /// is not a pressure.
  static constexpr std::optional<int> pressure_of(Output output) {
    if (output == Output::pressure_a) return pressure_a;
    if (output == Output::pressure_b) return pressure_b;
    return std::nullopt;
  }

  template <typename X>
  struct ValveFlows {
    X supply_to_a{}, a_to_tank{}, supply_to_b{}, b_to_tank{};
  };

  /// Laminar leakage through the clearance of an edge [m3/s].
  template <typename X, typename P>
  static X null_leak(const X& head_pa, const P& p, const PresentTerms& terms) {
    return terms.null_leak ? X(head_pa * p.valve_null_leakage_m3_per_s_pa) : X(0.0);
  }

  /// Opening of an edge, in the unit of the signal. `beyond` is the signal beyond the dead band.
  /// Both are positive.
  template <typename X, typename P, typename C>
  static X shaped(const X& beyond, const C& exponent, bool by_power, const P& p,
                  const PresentTerms& terms) {
    if (!by_power && !terms.table_opening) return beyond;
    const C& range = terms.pilot ? p.pilot_range_pa : p.valve_range_v;
    if (by_power) return power_opening(beyond, range, exponent);
    return table_opening(beyond, range,
                         std::array<C, 4>{p.opening_20, p.opening_40, p.opening_60, p.opening_80});
  }

  /// Opening of an edge, as spool travel [m]. A positive signal opens it.
  template <typename X, typename P, typename C>
  static X opening(bool to_tank, const X& signal, const C& overlap_v, const P& p,
                   const PresentTerms& terms) {
    const bool own_band = to_tank && terms.return_band;
    X beyond = signal - (own_band ? p.return_dead_band_pa : p.dead_band);
    if (terms.overlaps) beyond = beyond - overlap_v;
    if (!terms.null_opening && !(value_of(beyond) > 0.0)) return X(0.0);
    X y = terms.null_opening ? leaking_opening(beyond, p.valve_null_opening_v) : beyond;
    const bool own_power = to_tank && terms.return_power;
    const C& exponent = own_power     ? p.return_exponent
                        : terms.pilot ? p.pilot_exponent
                                      : p.valve_exponent;
    y = shaped(y, exponent, own_power || terms.power_opening, p, terms);
    if (terms.line_loss) y = series_opening(y, p.valve_line_opening_v);
    const X opening_m = y * p.gain;
    if (!to_tank || !terms.return_line) return opening_m;
    return series_opening(opening_m, p.return_line_opening_m);
  }

  /// Flow through an edge of a valve with any of the optional terms [m3/s].
  template <typename X, typename P, typename C>
  static X shaped_edge(bool to_tank, const X& opening_m, const C& area, const X& up_pa,
                       const X& down_pa, const P& p, const PresentTerms& terms) {
    const X head_pa = up_pa - down_pa;
    const X leak = null_leak(head_pa, p, terms);
    if (!(value_of(opening_m) > 0.0)) return leak;
    const X by_root = opening_m * (area * p.conductance);
    if (to_tank && terms.return_loss)
      return leak + flow_before_line(head_pa, by_root, p.return_line_resistance_pa_s_per_m3,
                                     p.leakage_smoothing_pa);
    const X across_pa = !to_tank && terms.compensator
                            ? compensated_head(head_pa, p.compensator_pressure_pa)
                            : head_pa;
    return leak + by_root * signed_sqrt(across_pa, p.leakage_smoothing_pa);
  }

  /// Flows through a valve with any of the optional terms.
  template <typename X, std::size_t M, typename P>
  static ValveFlows<X> shaped_valve_flows(const std::array<X, M>& x, const PlantInput<X>& in,
                                          const P& p, const PresentTerms& terms) {
    const X out = in.spool_command_v + p.valve_offset_v;
    const X back = -out;
    const X out_m = opening(false, out, p.overlap_supply_to_a_v, p, terms);
    const X back_m = opening(false, back, p.overlap_supply_to_b_v, p, terms);
    // Edges with the same opening are computed once.
    const bool own = terms.return_band || terms.return_power || terms.return_line || terms.overlaps;
    const X back_return_m = own ? opening(true, back, p.overlap_a_to_tank_v, p, terms) : back_m;
    const X out_return_m = own ? opening(true, out, p.overlap_b_to_tank_v, p, terms) : out_m;
    const X &p_A = x[pressure_a], &p_B = x[pressure_b];
    const X &P_s = in.supply_pressure_pa, &P_t = in.tank_pressure_pa;
    return {shaped_edge(false, out_m, p.gain_supply_to_a, P_s, p_A, p, terms),
            shaped_edge(true, back_return_m, p.gain_a_to_tank, p_A, P_t, p, terms),
            shaped_edge(false, back_m, p.gain_supply_to_b, P_s, p_B, p, terms),
            shaped_edge(true, out_return_m, p.gain_b_to_tank, p_B, P_t, p, terms)};
  }

  /// Spool travel, with the overlaps and the shape of the edges taken into account [m].
  template <typename X, typename P>
  static X shaped_spool(const PlantInput<X>& in, const P& p, const PresentTerms& terms) {
    const X out = in.spool_command_v + p.valve_offset_v;
    return opening(false, out, p.overlap_supply_to_a_v, p, terms) -
           opening(false, X(-out), p.overlap_supply_to_b_v, p, terms);
  }

  /// Servo flow: the mean over both chambers, Q_L = (Q_A + Q_B) / 2 [m3/s].
  template <typename X>
  static X servo_flow(const ValveFlows<X>& q) {
    return 0.5 * (q.supply_to_a - q.a_to_tank + q.b_to_tank - q.supply_to_b);
  }

  /// Internal leakage across the piston from A to B [m3/s]: an orifice (eq. 11) and a laminar path.
  template <typename X, std::size_t M, typename P>
  static X leakage_flow(const std::array<X, M>& x, const P& p, const PresentTerms& terms) {
    return internal_leak(X(x[pressure_a] - x[pressure_b]), p, terms);
  }

  /// Net flow into each chamber [m3/s]: through valve, leaks and check valves, minus the flow that
  /// the moving piston displaces.
  template <typename X, std::size_t M, typename P>
  static std::array<X, 2> chamber_flows(const std::array<X, M>& x, const X& speed_m_per_s,
                                        const ValveFlows<X>& q, const PlantInput<X>& in, const P& p,
                                        const PresentTerms& terms) {
    const X leak = leakage_flow(x, p, terms);
    const X &p_A = x[pressure_a], &p_B = x[pressure_b], &P_t = in.tank_pressure_pa;
    X flow_a = q.supply_to_a - q.a_to_tank - leak - speed_m_per_s * p.area_a_m2;
    X flow_b = q.supply_to_b - q.b_to_tank + leak + speed_m_per_s * p.area_b_m2;
    if (terms.external_leak) {
      flow_a = flow_a - (p_A - P_t) * p.external_leakage_a_m3_per_s_pa;
      flow_b = flow_b - (p_B - P_t) * p.external_leakage_b_m3_per_s_pa;
    }
    if (terms.make_up) {
      const auto& G = p.make_up_conductance_m3_per_s_pa;
      flow_a = flow_a + positive_part(X(P_t - p_A)) * G;
      flow_b = flow_b + positive_part(X(P_t - p_B)) * G;
    }
    if (terms.relief) {
      flow_a = flow_a - relief_flow(p_A, p);
      flow_b = flow_b - relief_flow(p_B, p);
    }
    return {flow_a, flow_b};
  }

  template <typename X, typename P>
  static X bulk_modulus(const X& pressure_pa, const P& p, const PresentTerms& terms) {
    if (!terms.air) return X(p.bulk_modulus_pa);
    return aerated_bulk_modulus(pressure_pa, p.bulk_modulus_pa, p.air_fraction, p.air_exponent);
  }

  template <typename X, std::size_t M>
  static X pressure_across(const std::array<X, M>& x) {
    return x[pressure_a] - x[pressure_b];
  }

  /// Force of the oil on the piston, outwards [N].
  template <typename X, std::size_t M, typename P>
  static X piston_force(const std::array<X, M>& x, const P& p) {
    return x[pressure_a] * p.area_a_m2 - x[pressure_b] * p.area_b_m2;
  }

  /// Signal of the spool beyond its dead band, in either direction [V or Pa].
  template <typename X, typename P>
  static X beyond_dead_band(const PlantInput<X>& in, const P& p) {
    const X out = in.spool_command_v + p.valve_offset_v;
    return (value_of(out) < 0.0 ? X(-out) : out) - p.dead_band;
  }

  /// Flow that the valve demands from the pump, as a fraction from 0 to 1.
  template <typename X, typename P>
  static X demand(const PlantInput<X>& in, const P& p, const PresentTerms& terms) {
    using std::tanh;
    const double whole = terms.pilot ? 1e5 : 0.1;  // beyond the dead band [Pa or V]
    return tanh(X(positive_part(beyond_dead_band(in, p)) / whole));
  }

  /// Time derivative of the demand time [1], which counts how long the valve has demanded flow from
  /// the pump. Without a demand, the demand time decays.
  template <typename X, std::size_t M, typename P>
  [[gnu::noinline]] static X demand_rate(const std::array<X, M>& x, const PlantInput<X>& in,
                                         const P& p, const PresentTerms& terms) {
    const X asked = demand(in, p, terms);
    return asked - (1.0 - asked) * x[static_cast<std::size_t>(terms.pump)] / p.pump_delay_s;
  }

  template <typename X, std::size_t M, typename P>
  [[gnu::noinline]] static X largest_flow(const std::array<X, M>& x, const P& p,
                                          const PresentTerms& terms) {
    if (terms.pump < 0) return X(p.pump_flow_m3_per_s);
    const X& demand_s = x[static_cast<std::size_t>(terms.pump)];
    return two_stages(demand_s, X(demand_s * p.pump_first_rate_m3_per_s2 + p.pump_flow_m3_per_s),
                      p.pump_second_flow_m3_per_s, p.pump_delay_s, p.pump_rise_s);
  }

  /// Flow from the pump to the tank through the open centre of the valve [m3/s].
  template <typename X, typename P>
  [[gnu::noinline]] static X bypass_flow(const PlantInput<X>& in, const P& p,
                                         const PresentTerms& terms) {
    const X closed =
        beyond_dead_band(in, p) / (terms.pilot ? p.bypass_range_pa : p.valve_bypass_range_v);
    const X opening_m = positive_part(X(1.0 - positive_part(closed))) * p.bypass_opening_m;
    return opening_m * p.conductance *
           signed_sqrt(X(in.supply_pressure_pa - in.tank_pressure_pa), p.leakage_smoothing_pa);
  }

  /// Pressure that the pump maintains [Pa]: its limit or, with load sensing, the pressure of the
  /// driven chamber plus the margin, up to the limit.
  template <typename X, std::size_t M, typename P>
  [[gnu::noinline]] static X sensed_pressure(const X& limit_pa, const std::array<X, M>& x,
                                             const PlantInput<X>& in, const P& p,
                                             const PresentTerms& terms) {
    const X out = in.spool_command_v + p.valve_offset_v;
    const X& driven_pa = value_of(out) < 0.0 ? x[pressure_b] : x[pressure_a];
    const X kept_pa = in.tank_pressure_pa + p.load_sensing_margin_pa +
                      demand(in, p, terms) * positive_part(X(driven_pa - in.tank_pressure_pa));
    return value_of(kept_pa) < value_of(limit_pa) ? kept_pa : limit_pa;
  }

  /// Flow of the pump [m3/s]: as much as it needs to maintain its pressure, up to its largest flow.
  template <typename X, std::size_t M, typename P>
  static X pump_flow(const X& limit_pa, const std::array<X, M>& x, const PlantInput<X>& in,
                     const P& p, const PresentTerms& terms) {
    const X kept_pa = terms.load_sensing ? sensed_pressure(limit_pa, x, in, p, terms) : limit_pa;
    const X asked = asked_flow(kept_pa, in, p);
    if (!terms.pump_flow) return asked;
    const X largest = largest_flow(x, p, terms);
    return value_of(asked) > value_of(largest) ? largest : asked;
  }

  /// Time derivative of the supply pressure at the valve [Pa/s].
  ///
  /// @param limit_pa  pressure to which the pump is limited
  /// @param taken     flow that the valve takes from the supply [m3/s]
  template <typename X, std::size_t M, typename P>
  static X supply_rate(const X& limit_pa, const X& taken, const std::array<X, M>& x,
                       const PlantInput<X>& in, const P& p, const PresentTerms& terms) {
    X flow = pump_flow(limit_pa, x, in, p, terms) - taken;
    if (terms.bypass) flow = flow - bypass_flow(in, p, terms);
    return supply_rise(flow, in, p, terms);
  }
};

}  // namespace rigcal::model
