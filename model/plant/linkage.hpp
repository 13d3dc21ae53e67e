#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "model/plant/linkage_parameters.hpp"
#include "model/plant/plant_input.hpp"
#include "model/plant/terms.hpp"

namespace rigcal::model {

/// A cylinder of two chambers that turns an arm, as on an excavator, behind an electric or a
/// pilot-operated valve and a pump of limited flow.
///
///   J omega' = D(theta) (A_A p_A - A_B p_B) - c omega - M_c(omega) + M_stops - M(theta)
///   p_A'     = beta(p_A) / V_A (Q_A - Q_leak - G_A (p_A - P_t) + Q_mA - A_A D omega)
///   p_B'     = beta(p_B) / V_B (Q_leak - Q_B - G_B (p_B - P_t) + Q_mB + A_B D omega)
///
/// D is the lever: travel of the piston per angle, and so moment per force. Positive angle and
/// piston travel go together: chamber A is the one whose pressure raises the angle.
struct LinkagePlant {
  static constexpr std::string_view kName = "linkage";  ///< in campaign files
  static constexpr int kStates = 4;
  enum State {
    angle,
    angular_velocity,
    pressure_a,
    pressure_b,
    position = angle,  ///< what System calls the first two
    velocity = angular_velocity
  };
  template <typename T>
  using Parameters = LinkageParameters<T>;
  /// Parameters and quantities that depend only on them.
  template <typename C>
  struct Coefficients : Parameters<C> {
    C gain{};              ///< spool travel per signal, of the valve that there is [m/V or m/Pa]
    C dead_band{};         ///< [V or Pa]
    C conductance{};       ///< flow of an edge per spool travel and root of pressure
    C leak_conductance{};  ///< orifice leakage per root of pressure
    C inverse_inertia{};   ///< [1/(kg m2)]
    C retracted_m{};       ///< travel at the lower stop, from the reference angle
    C extended_m{};        ///< travel at the upper stop

    Coefficients() = default;
    explicit Coefficients(const Parameters<C>& p)
        : Parameters<C>(p),
          gain(p.valve_gain_m_per_v + p.pilot_gain_m_per_pa),  // one of them is zero
          dead_band(p.valve_dead_band_v + p.pilot_dead_band_pa),
          conductance(
              orifice_conductance(p.discharge_coefficient, p.area_gradient_m, p.density_kg_per_m3)),
          leak_conductance(
              orifice_conductance(p.leakage_coefficient, p.leakage_area_m2, p.density_kg_per_m3)),
          inverse_inertia(1.0 / p.inertia_kg_m2),
          retracted_m(travel(C(p.lower_stop_rad), *this)),
          extended_m(travel(C(p.upper_stop_rad), *this)) {}
  };
  template <typename T>
  static constexpr const auto& fields() {
    return kLinkageFields<T>;
  }
  static constexpr std::array<StateRow, kStates> kStateRows{
      StateRow{"angle", "rad", "angle of the joint", 1e-6, 0.1},
      StateRow{"angular_velocity", "rad/s", "angular velocity of the joint", 1e-5, 0.1}, kPressureA,
      kPressureB};

  /// The state that an output reads, but for its sensor; none: it takes more.
  static constexpr std::optional<int> state_of(Output output) {
    switch (output) {
      case Output::angle:
        return angle;
      case Output::angular_velocity:
        return angular_velocity;
      case Output::pressure_a:
        return pressure_a;
      case Output::pressure_b:
        return pressure_b;
      default:
        return std::nullopt;
    }
  }

  /// No output: the chambers differ.
  static bool reversible(Output, const PresentTerms&) { return false; }

  /// Travel of the piston per angle [m/rad].
  template <typename X, typename C>
  static X lever(const X& theta, const Coefficients<C>& p) {
    const X from = theta - p.reference_angle_rad;
    return (from * p.lever_curvature_m_per_rad3 + p.lever_gradient_m_per_rad2) * from +
           p.lever_m_per_rad;
  }

  /// Travel of the piston from the reference angle [m]: the integral of the lever.
  template <typename X, typename C>
  static X travel(const X& theta, const Parameters<C>& p) {
    const X from = theta - p.reference_angle_rad;
    return ((from * (p.lever_curvature_m_per_rad3 / 3.0) + p.lever_gradient_m_per_rad2 * 0.5) *
                from +
            p.lever_m_per_rad) *
           from;
  }

  /// Moment of the load against positive angle [N m].
  template <typename X, typename C>
  static X gravity_moment(const X& theta, const Coefficients<C>& p) {
    const X from = theta - p.reference_angle_rad;
    return (from * p.gravity_moment_curvature_n_m_per_rad2 +
            p.gravity_moment_gradient_n_m_per_rad) *
               from +
           p.gravity_moment_n_m;
  }

  /// Spool travel that opens an edge from the supply [m], from a signal that opens it when
  /// positive.
  template <typename X, typename C>
  static X opening(const X& signal, const Coefficients<C>& p, const PresentTerms& terms) {
    const X beyond = signal - p.dead_band;
    if (!(value_of(beyond) > 0.0)) return X(0.0);
    if (!terms.power_opening) return beyond * p.gain;
    return power_opening(beyond, p.pilot_range_pa, p.pilot_exponent) * p.gain;
  }

  /// The same of an edge to the tank, with what its line loses.
  template <typename X, typename C>
  static X return_opening(const X& signal, const Coefficients<C>& p, const PresentTerms& terms) {
    const X beyond = signal - (terms.return_band ? p.return_dead_band_pa : p.dead_band);
    if (!(value_of(beyond) > 0.0)) return X(0.0);
    X opening_m = beyond * p.gain;
    if (terms.return_power || terms.power_opening)
      opening_m = power_opening(beyond, p.pilot_range_pa,
                                terms.return_power ? p.return_exponent : p.pilot_exponent) *
                  p.gain;
    return terms.return_line ? series_opening(opening_m, p.return_line_opening_m) : opening_m;
  }

  template <typename X>
  struct ValveFlows {
    X supply_to_a{}, a_to_tank{}, supply_to_b{}, b_to_tank{};
  };

  template <typename X, std::size_t M, typename C>
  static ValveFlows<X> valve_flows(const std::array<X, M>& x, const PlantInput<X>& in,
                                   const Coefficients<C>& p, const PresentTerms& terms) {
    const X out = in.spool_command_v + p.valve_offset_v;
    const X back = -out;
    const X out_m = opening(out, p, terms);
    const X back_m = opening(back, p, terms);
    const bool own = terms.return_band || terms.return_power || terms.return_line;
    const X out_return_m = own ? return_opening(out, p, terms) : out_m;
    const X back_return_m = own ? return_opening(back, p, terms) : back_m;
    const X &p_A = x[pressure_a], &p_B = x[pressure_b];
    const X &P_s = in.supply_pressure_pa, &P_t = in.tank_pressure_pa;
    return {edge(out_m, p.gain_supply_to_a, P_s, p_A, p, terms),
            edge_to_tank(back_return_m, p.gain_a_to_tank, p_A, P_t, p, terms),
            edge(back_m, p.gain_supply_to_b, P_s, p_B, p, terms),
            edge_to_tank(out_return_m, p.gain_b_to_tank, p_B, P_t, p, terms)};
  }

  /// Flow that the valve takes from the supply [m3/s].
  template <typename X, std::size_t M, typename C>
  static X supply_flow(const std::array<X, M>& x, const PlantInput<X>& in, const Coefficients<C>& p,
                       const PresentTerms& terms) {
    const ValveFlows<X> q = valve_flows(x, in, p, terms);
    const X taken = q.supply_to_a + q.supply_to_b;
    return terms.bypass ? X(taken + bypass_flow(in, p)) : taken;
  }

  /// Flow from the pump to the tank through the open centre of the valve [m3/s].
  template <typename X, typename C>
  static X bypass_flow(const PlantInput<X>& in, const Coefficients<C>& p) {
    const X closed = beyond_dead_band(in, p) / p.bypass_range_pa;
    const X opening_m = positive_part(X(1.0 - positive_part(closed))) * p.bypass_opening_m;
    return opening_m * p.conductance *
           signed_sqrt(X(in.supply_pressure_pa - in.tank_pressure_pa), p.leakage_smoothing_pa);
  }

  /// Signal of the spool beyond its dead band, of either direction [V or Pa].
  template <typename X, typename C>
  static X beyond_dead_band(const PlantInput<X>& in, const Coefficients<C>& p) {
    const X out = in.spool_command_v + p.valve_offset_v;
    return (value_of(out) < 0.0 ? X(-out) : out) - p.dead_band;
  }

  /// Flow of the pump [m3/s]: what its pressure asks for, within its largest.
  ///
  /// @param asked_m3_per_s  flow through the supply's resistance
  template <typename X, std::size_t M, typename C>
  static X pump_flow(const X& asked_m3_per_s, const std::array<X, M>& x, const Coefficients<C>& p,
                     const PresentTerms& terms) {
    if (!terms.pump_flow) return asked_m3_per_s;
    const X largest = largest_flow(x, p, terms);
    return value_of(asked_m3_per_s) > value_of(largest) ? largest : asked_m3_per_s;
  }

  template <typename X, std::size_t M, typename C>
  static X largest_flow(const std::array<X, M>& x, const Coefficients<C>& p,
                        const PresentTerms& terms) {
    if (terms.pump < 0) return X(p.pump_flow_m3_per_s);
    const X& demand_s = x[static_cast<std::size_t>(terms.pump)];
    return two_stages(demand_s, X(demand_s * p.pump_first_rate_m3_per_s2 + p.pump_flow_m3_per_s),
                      p.pump_second_flow_m3_per_s, p.pump_delay_s, p.pump_rise_s);
  }

  /// Rate of the time for which the pump has been asked for flow [1]. Without a demand the time
  /// fades.
  template <typename X, std::size_t M, typename C>
  static X demand_rate(const std::array<X, M>& x, const PlantInput<X>& in, const Coefficients<C>& p,
                       const PresentTerms& terms) {
    using std::tanh;
    // A signal beyond the dead band that counts as a demand [V or Pa].
    const double whole = terms.pilot ? 1e5 : 0.1;
    const X demand = tanh(X(positive_part(beyond_dead_band(in, p)) / whole));
    return demand - (1.0 - demand) * x[static_cast<std::size_t>(terms.pump)] / p.pump_delay_s;
  }

  /// Internal leakage across the piston, A to B [m3/s]: orifice (eq. 11) and laminar path.
  template <typename X, std::size_t M, typename C>
  static X leakage_flow(const std::array<X, M>& x, const Coefficients<C>& p,
                        const PresentTerms& terms) {
    const X P_L = x[pressure_a] - x[pressure_b];
    const X laminar = P_L * p.laminar_leakage_m3_per_s_pa;
    if (!terms.orifice_leak) return laminar;
    return laminar + orifice_leakage(P_L, p.leak_conductance, p.leakage_smoothing_pa);
  }

  /// Moment of stops and support on the arm, towards larger angles [N m].
  template <typename X, typename C>
  static X stops_moment(const X& theta, const X& omega, const Coefficients<C>& p) {
    return stop_force(X(p.lower_stop_rad - theta), X(-omega), p.angle_stop_stiffness_n_m_per_rad,
                      p.angle_stop_damping_s_per_rad) -
           stop_force(X(theta - p.upper_stop_rad), omega, p.angle_stop_stiffness_n_m_per_rad,
                      p.angle_stop_damping_s_per_rad);
  }

  /// Oil in the chambers [m3]. An arm pressed into its stop does not squeeze the oil below a
  /// thousandth of the swept volume.
  template <typename X, typename C>
  static std::array<X, 2> volumes(const X& theta, const Coefficients<C>& p) {
    const X x = travel(theta, p);
    const double least = 1e-3 * value_of(X(p.extended_m - p.retracted_m));
    return {at_least(X((x - p.retracted_m) * p.area_a_m2 + p.dead_volume_a_m3),
                     least * value_of(p.area_a_m2)),
            at_least(X((p.extended_m - x) * p.area_b_m2 + p.dead_volume_b_m3),
                     least * value_of(p.area_b_m2))};
  }

  /// Force of the oil on the piston, outwards [N].
  template <typename X, std::size_t M, typename C>
  static X piston_force(const std::array<X, M>& x, const Coefficients<C>& p) {
    return x[pressure_a] * p.area_a_m2 - x[pressure_b] * p.area_b_m2;
  }

  /// Time derivative of the state [rad/s, rad/s2, Pa/s, Pa/s].
  template <typename X, std::size_t M, typename C>
  static std::array<X, kStates> derivative(const std::array<X, M>& x, const PlantInput<X>& in,
                                           const Coefficients<C>& p, const PresentTerms& terms) {
    const X& omega = x[angular_velocity];
    const X D = lever(x[angle], p);
    X moment = D * piston_force(x, p) - omega * p.joint_damping_n_m_s_per_rad -
               gravity_moment(x[angle], p) + stops_moment(x[angle], omega, p);
    if (terms.friction)
      moment =
          moment - p.joint_friction_n_m * smooth_sign(omega, p.joint_friction_smoothing_rad_per_s);
    const ValveFlows<X> q = valve_flows(x, in, p, terms);
    const X leak = leakage_flow(x, p, terms);
    const X speed = D * omega;
    X flow_a = q.supply_to_a - q.a_to_tank - leak - speed * p.area_a_m2;
    X flow_b = q.supply_to_b - q.b_to_tank + leak + speed * p.area_b_m2;
    if (terms.external_leak) {
      flow_a = flow_a - (x[pressure_a] - in.tank_pressure_pa) * p.external_leakage_a_m3_per_s_pa;
      flow_b = flow_b - (x[pressure_b] - in.tank_pressure_pa) * p.external_leakage_b_m3_per_s_pa;
    }
    if (terms.make_up) {
      const auto& G = p.make_up_conductance_m3_per_s_pa;
      flow_a = flow_a + positive_part(X(in.tank_pressure_pa - x[pressure_a])) * G;
      flow_b = flow_b + positive_part(X(in.tank_pressure_pa - x[pressure_b])) * G;
    }
    const auto volume = volumes(x[angle], p);
    return {omega, moment * p.inverse_inertia,
            flow_a * bulk_modulus(x[pressure_a], p, terms) / volume[0],
            flow_b * bulk_modulus(x[pressure_b], p, terms) / volume[1]};
  }

  /// Outputs of the plant other than command and pilot pressure. Servo and work flow are the means
  /// of both chambers: Q_L = (Q_A + Q_B) / 2.
  template <typename X, std::size_t M, typename C>
  static X output(Output output, const std::array<X, M>& x, const PlantInput<X>& in,
                  const Coefficients<C>& p, const PresentTerms& terms) {
    const X& omega = x[angular_velocity];
    switch (output) {
      case Output::angle:
        return x[angle];
      case Output::angular_velocity:
        return omega;
      case Output::position:
        return travel(x[angle], p);
      case Output::velocity:
        return lever(x[angle], p) * omega;
      case Output::acceleration: {
        const X from = x[angle] - p.reference_angle_rad;
        const X slope = from * (2.0 * p.lever_curvature_m_per_rad3) + p.lever_gradient_m_per_rad2;
        return slope * omega * omega +
               lever(x[angle], p) * derivative(x, in, p, terms)[angular_velocity];
      }
      case Output::load_pressure:
        return x[pressure_a] - x[pressure_b];
      case Output::pressure_a:
        return x[pressure_a];
      case Output::pressure_b:
        return x[pressure_b];
      case Output::force:
        return piston_force(x, p);
      case Output::spool: {
        const X out = in.spool_command_v + p.valve_offset_v;
        return opening(out, p, terms) - opening(X(-out), p, terms);
      }
      case Output::servo_flow: {
        const ValveFlows<X> q = valve_flows(x, in, p, terms);
        return 0.5 * (q.supply_to_a - q.a_to_tank + q.b_to_tank - q.supply_to_b);
      }
      case Output::leakage_flow:
        return leakage_flow(x, p, terms);
      case Output::work_flow:
        return lever(x[angle], p) * omega * (0.5 * (p.area_a_m2 + p.area_b_m2));
      case Output::payload_acceleration:
      case Output::command:
      case Output::pilot_pressure:
        break;
    }
    return X(0.0);
  }

  /// State at rest: at the reference angle, or at the nearer stop. The pressures balance the load,
  /// and their sum is that of supply and tank.
  template <typename C>
  static std::array<C, kStates> rest(const PlantInput<C>& in, const Coefficients<C>& p,
                                     const PresentTerms&) {
    return settled({C(p.reference_angle_rad), C(0.0), C(0.0), C(0.0)}, in, p, false, false);
  }

  /// Initial state from the readings of the sensors, as far as there are any; missing pressures
  /// balance the load.
  template <typename C>
  static std::array<C, kStates> initial(const PlantInput<C>& in, const Coefficients<C>& p,
                                        const PresentTerms& terms) {
    return settled({C((p.initial_angle_rad - p.angle_offset_rad) / p.angle_gain),
                    p.initial_angular_velocity_rad_per_s,
                    C((p.initial_pressure_a_pa - p.pressure_a_offset_pa) / p.pressure_a_gain),
                    C((p.initial_pressure_b_pa - p.pressure_b_offset_pa) / p.pressure_b_gain)},
                   in, p, terms.initial_pressure_a, terms.initial_pressure_b);
  }

 private:
  /// Flow of one edge [m3/s]: its orifice, and the laminar leak of its clearance.
  template <typename X, typename C>
  static X edge(const X& opening_m, const C& area, const X& up_pa, const X& down_pa,
                const Coefficients<C>& p, const PresentTerms& terms) {
    const X head_pa = up_pa - down_pa;
    const X leak = terms.null_leak ? head_pa * p.valve_null_leakage_m3_per_s_pa : X(0.0);
    if (!(value_of(opening_m) > 0.0)) return leak;
    return leak + opening_m * (area * p.conductance) * signed_sqrt(head_pa, p.leakage_smoothing_pa);
  }

  /// The same for an edge to the tank, whose line has a laminar loss.
  template <typename X, typename C>
  static X edge_to_tank(const X& opening_m, const C& area, const X& up_pa, const X& tank_pa,
                        const Coefficients<C>& p, const PresentTerms& terms) {
    if (!terms.return_loss || !(value_of(opening_m) > 0.0))
      return edge(opening_m, area, up_pa, tank_pa, p, terms);
    const X head_pa = up_pa - tank_pa;
    const X orifice =
        flow_before_line(head_pa, X(opening_m * (area * p.conductance)),
                         p.return_line_resistance_pa_s_per_m3, p.leakage_smoothing_pa);
    return terms.null_leak ? X(orifice + head_pa * p.valve_null_leakage_m3_per_s_pa) : orifice;
  }

  template <typename X, typename C>
  static X bulk_modulus(const X& pressure_pa, const Coefficients<C>& p, const PresentTerms& terms) {
    if (!terms.air) return X(p.bulk_modulus_pa);
    return aerated_bulk_modulus(pressure_pa, p.bulk_modulus_pa, p.air_fraction, p.air_exponent);
  }

  /// Fills in the pressures that are not given and puts an arm that reads as beyond a stop onto it,
  /// pressed in by what the pressures do not balance.
  template <typename C>
  static std::array<C, kStates> settled(std::array<C, kStates> x, const PlantInput<C>& in,
                                        const Coefficients<C>& p, bool given_a, bool given_b) {
    const C D = lever(x[angle], p);
    const C load = gravity_moment(x[angle], p) / D;  // as a force on the piston
    const C &A = p.area_a_m2, &B = p.area_b_m2;
    if (!given_a && !given_b) {
      x[pressure_a] = (B * (in.supply_pressure_pa + in.tank_pressure_pa) + load) / (A + B);
      given_a = true;
    }
    if (!given_a) x[pressure_a] = (B * x[pressure_b] + load) / A;
    if (!given_b) x[pressure_b] = (A * x[pressure_a] - load) / B;
    const C depth =
        D * (A * x[pressure_a] - B * x[pressure_b] - load) / p.angle_stop_stiffness_n_m_per_rad;
    if (value_of(x[angle]) <= value_of(p.lower_stop_rad)) {
      x[angle] = value_of(depth) < 0.0 ? C(p.lower_stop_rad + depth) : C(p.lower_stop_rad);
      x[angular_velocity] = C(0.0);
    } else if (value_of(x[angle]) >= value_of(p.upper_stop_rad)) {
      x[angle] = value_of(depth) > 0.0 ? C(p.upper_stop_rad + depth) : C(p.upper_stop_rad);
      x[angular_velocity] = C(0.0);
    }
    return x;
  }
};

}  // namespace rigcal::model
