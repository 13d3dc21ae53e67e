#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "model/plant/chambers.hpp"
#include "model/plant/linkage_parameters.hpp"
#include "model/plant/piston_travel.hpp"
#include "model/plant/plant_input.hpp"
#include "model/plant/terms.hpp"

namespace rigcal::model {

/// A cylinder with two chambers that turns an arm, as on an excavator, driven by an electric or
/// pilot-operated valve and a pump with limited flow.
///
///   J omega' = D(theta) (A_A p_A - A_B p_B - F_dry(D omega)) - c omega - M_c(omega) + M_stops
///              - M(theta) - M_ext
///   p_A'     = beta(p_A) / V_A (Q_A - Q_leak - G_A (p_A - P_t) + Q_mA - A_A D omega)
///   p_B'     = beta(p_B) / V_B (Q_leak - Q_B - G_B (p_B - P_t) + Q_mB + A_B D omega)
///
/// D is the lever arm: piston travel per angle, and therefore moment per force. The piston moves at
/// D omega, and its friction acts on the arm by the same lever. Pressure in chamber A increases
/// both the piston travel and the angle.
struct LinkagePlant : Chambers {
  static constexpr std::string_view kName = "linkage";  ///< in campaign files
  enum Motion {
    angle,
    angular_velocity,
    position = angle,  ///< System uses these names for the first two states
    velocity = angular_velocity
  };
  template <typename T>
  using Parameters = LinkageParameters<T>;
  /// Parameters and quantities that depend only on them.
  template <typename C>
  struct Coefficients : ChamberCoefficients<Parameters<C>> {
    TravelLaw law = TravelLaw::polynomial;
    C inverse_inertia{};  ///< [1/(kg m2)]
    C retracted_m{};      ///< travel at the lower stop
    C extended_m{};       ///< travel at the upper stop

    Coefficients() = default;
    explicit Coefficients(const Parameters<C>& p)
        : ChamberCoefficients<Parameters<C>>(as_cylinder(p)),
          law(travel_law(p)),
          inverse_inertia(1.0 / p.inertia_kg_m2),
          retracted_m(travel(C(p.lower_stop_rad), *this)),
          extended_m(travel(C(p.upper_stop_rad), *this)) {}
  };
  /// Returns the parameters, with a rotary actuator as a cylinder of equal areas on a lever of 1
  /// m/rad. Its travel in m is then the angle in rad, and its force in N the moment in N m.
  template <typename C>
  static Parameters<C> as_cylinder(Parameters<C> p) {
    if (!(value_of(p.displacement_m3_per_rad) > 0.0)) return p;
    p.area_a_m2 = p.displacement_m3_per_rad;
    p.area_b_m2 = p.displacement_m3_per_rad;
    p.lever_m_per_rad = C(1.0);
    return p;
  }
  template <typename T>
  static constexpr const auto& fields() {
    return kLinkageFields<T>;
  }
  static constexpr std::array<StateRow, kStates> kStateRows{
      StateRow{"angle", "rad", "angle of the joint", 1e-6, 0.1},
      StateRow{"angular_velocity", "rad/s", "angular velocity of the joint", 1e-5, 0.1}, kPressureA,
      kPressureB};

  /// Index of the state that an output equals, apart from sensor errors; std::nullopt if the output
  /// depends on more than one state.
  static constexpr std::optional<int> state_of(Output output) {
    if (output == Output::angle) return angle;
    if (output == Output::angular_velocity) return angular_velocity;
    return pressure_of(output);
  }

  /// No output is reversible, because the chambers differ.
  static bool reversible(Output, const PresentTerms&) { return false; }

  /// Piston travel per angle [m/rad].
  template <typename X, typename C>
  static X lever(const X& theta, const Coefficients<C>& p) {
    if (p.law != TravelLaw::polynomial) return other_travel(theta, p).lever_m_per_rad;
    const X from = theta - p.reference_angle_rad;
    return (from * p.lever_curvature_m_per_rad3 + p.lever_gradient_m_per_rad2) * from +
           p.lever_m_per_rad;
  }

  /// Piston travel [m]: the integral of the lever from the reference angle, or the table.
  template <typename X, typename C>
  static X travel(const X& theta, const Coefficients<C>& p) {
    if (p.law != TravelLaw::polynomial) return other_travel(theta, p).travel_m;
    return polynomial_travel(theta, p);
  }

  /// Piston travel by the polynomial [m].
  template <typename X, typename C>
  static X polynomial_travel(const X& theta, const Coefficients<C>& p) {
    const X from = theta - p.reference_angle_rad;
    return ((from * (p.lever_curvature_m_per_rad3 / 3.0) + p.lever_gradient_m_per_rad2 * 0.5) *
                from +
            p.lever_m_per_rad) *
           from;
  }

  /// Change of the lever per angle [m/rad2].
  template <typename X, typename C>
  static X lever_slope(const X& theta, const Coefficients<C>& p) {
    if (p.law != TravelLaw::polynomial) return other_travel(theta, p).slope_m_per_rad2;
    return polynomial_slope(theta, p);
  }

  /// Change of the polynomial's lever per angle [m/rad2].
  template <typename X, typename C>
  static X polynomial_slope(const X& theta, const Coefficients<C>& p) {
    const X from = theta - p.reference_angle_rad;
    return from * (2.0 * p.lever_curvature_m_per_rad3) + p.lever_gradient_m_per_rad2;
  }

  /// Moment of the load, opposing positive angles [N m].
  template <typename X, typename C>
  static X gravity_moment(const X& theta, const Coefficients<C>& p) {
    const X from = theta - p.reference_angle_rad;
    return (from * p.gravity_moment_curvature_n_m_per_rad2 +
            p.gravity_moment_gradient_n_m_per_rad) *
               from +
           p.gravity_moment_n_m;
  }

  template <typename X, std::size_t M, typename C>
  static ValveFlows<X> valve_flows(const std::array<X, M>& x, const PlantInput<X>& in,
                                   const Coefficients<C>& p, const PresentTerms& terms) {
    return shaped_valve_flows(x, in, p, terms);
  }

  /// Flow that the valve takes from the supply [m3/s].
  template <typename X, std::size_t M, typename C>
  static X supply_flow(const std::array<X, M>& x, const PlantInput<X>& in, const Coefficients<C>& p,
                       const PresentTerms& terms) {
    const ValveFlows<X> q = valve_flows(x, in, p, terms);
    return q.supply_to_a + q.supply_to_b;
  }

  /// Moment of stops and support on the arm, directed towards larger angles [N m].
  template <typename X, typename C>
  static X stops_moment(const X& theta, const X& omega, const Coefficients<C>& p) {
    return stop_force(X(p.lower_stop_rad - theta), X(-omega), p.angle_stop_stiffness_n_m_per_rad,
                      p.angle_stop_damping_s_per_rad) -
           stop_force(X(theta - p.upper_stop_rad), omega, p.angle_stop_stiffness_n_m_per_rad,
                      p.angle_stop_damping_s_per_rad);
  }

  /// Oil volumes of the chambers [m3]. They are at least a thousandth of the swept volume, even if
  /// the arm is pressed into a stop.
  template <typename X, typename C>
  static std::array<X, 2> volumes(const X& theta, const Coefficients<C>& p) {
    // A choice between two travels would keep the compiler from joining the last product of the
    // polynomial with the difference below, and change the last bit of a result.
    if (p.law != TravelLaw::polynomial) return volumes_at(X(other_travel(theta, p).travel_m), p);
    return volumes_at(polynomial_travel(theta, p), p);
  }

  /// @param x  travel of the piston [m]
  template <typename X, typename C>
  static std::array<X, 2> volumes_at(const X& x, const Coefficients<C>& p) {
    const double least = 1e-3 * value_of(X(p.extended_m - p.retracted_m));
    return {at_least(X((x - p.retracted_m) * p.area_a_m2 + p.dead_volume_a_m3),
                     least * value_of(p.area_a_m2)),
            at_least(X((p.extended_m - x) * p.area_b_m2 + p.dead_volume_b_m3),
                     least * value_of(p.area_b_m2))};
  }

  template <typename X, std::size_t M, typename C>
  static X piston_velocity(const std::array<X, M>& x, const Coefficients<C>& p) {
    return lever(x[angle], p) * x[angular_velocity];
  }

  /// Moment of dry friction in the joint [N m].
  template <typename X, typename C>
  static X joint_friction(const X& omega, const Coefficients<C>& p) {
    return p.joint_friction_n_m * smooth_sign(omega, p.joint_friction_smoothing_rad_per_s);
  }

  /// Dry friction of piston and rod [N]. Not inlined, to keep the code of rigs without it short.
  template <typename X, std::size_t M, typename C>
  [[gnu::noinline]] static X rod_friction(const std::array<X, M>& x, const Coefficients<C>& p,
                                          const PresentTerms& terms) {
    return friction_of<LinkagePlant>(x, p, terms);
  }

  /// Moment that the actuator transmits to the arm [N m]: that of the pressures and stops, less dry
  /// friction.
  template <typename X, std::size_t M, typename C>
  static X torque(const std::array<X, M>& x, const Coefficients<C>& p, const PresentTerms& terms) {
    const X& omega = x[angular_velocity];
    const X D = lever(x[angle], p);
    X moment = D * piston_force(x, p) + stops_moment(x[angle], omega, p);
    if (terms.joint_friction) moment = moment - joint_friction(omega, p);
    if (terms.friction) moment = moment - D * rod_friction(x, p, terms);
    return moment;
  }

  /// Time derivative of the state [rad/s, rad/s2, Pa/s, Pa/s].
  template <typename X, std::size_t M, typename C>
  static std::array<X, kStates> derivative(const std::array<X, M>& x, const PlantInput<X>& in,
                                           const Coefficients<C>& p, const PresentTerms& terms) {
    const X& omega = x[angular_velocity];
    const X D = lever(x[angle], p);
    X moment = D * piston_force(x, p) - omega * p.joint_damping_n_m_s_per_rad -
               gravity_moment(x[angle], p) + stops_moment(x[angle], omega, p);
    if (terms.joint_friction) moment = moment - joint_friction(omega, p);
    if (terms.friction) moment = moment - D * rod_friction(x, p, terms);
    if (terms.external_load) moment = moment - in.external_load;
    const auto flow = chamber_flows(x, X(D * omega), valve_flows(x, in, p, terms), in, p, terms);
    const auto volume = volumes(x[angle], p);
    return {omega, moment * p.inverse_inertia,
            flow[0] * bulk_modulus(x[pressure_a], p, terms) / volume[0],
            flow[1] * bulk_modulus(x[pressure_b], p, terms) / volume[1]};
  }

  /// Outputs of the plant other than command and pilot pressure. Servo flow and work flow are means
  /// over both chambers: Q_L = (Q_A + Q_B) / 2.
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
        if (p.law != TravelLaw::polynomial) {
          const PistonTravel<X> at = other_travel(x[angle], p);
          return at.slope_m_per_rad2 * omega * omega +
                 at.lever_m_per_rad * derivative(x, in, p, terms)[angular_velocity];
        }
        return polynomial_slope(x[angle], p) * omega * omega +
               lever(x[angle], p) * derivative(x, in, p, terms)[angular_velocity];
      }
      case Output::load_pressure:
        return x[pressure_a] - x[pressure_b];
      case Output::pressure_a:
        return x[pressure_a];
      case Output::pressure_b:
        return x[pressure_b];
      case Output::force:
        return terms.friction ? X(piston_force(x, p) - rod_friction(x, p, terms))
                              : piston_force(x, p);
      case Output::torque:
        return torque(x, p, terms);
      case Output::spool:
        return shaped_spool(in, p, terms);
      case Output::servo_flow:
        return servo_flow(valve_flows(x, in, p, terms));
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

  /// State at rest: at the reference angle, or at the closer stop if that is out of reach. The
  /// pressures balance the load, and their sum is that of supply and tank pressure.
  template <typename C>
  static std::array<C, kStates> rest(const PlantInput<C>& in, const Coefficients<C>& p,
                                     const PresentTerms& terms) {
    return settled({C(p.reference_angle_rad), C(0.0), C(0.0), C(0.0)}, in, p, terms, false, false);
  }

  /// Initial state from those sensor readings that were given. Missing pressures balance the load.
  template <typename C>
  static std::array<C, kStates> initial(const PlantInput<C>& in, const Coefficients<C>& p,
                                        const PresentTerms& terms) {
    return settled({C((p.initial_angle_rad - p.angle_offset_rad) / p.angle_gain),
                    p.initial_angular_velocity_rad_per_s,
                    C((p.initial_pressure_a_pa - p.pressure_a_offset_pa) / p.pressure_a_gain),
                    C((p.initial_pressure_b_pa - p.pressure_b_offset_pa) / p.pressure_b_gain)},
                   in, p, terms, terms.initial_pressure_a, terms.initial_pressure_b);
  }

 private:
  /// Travel by a triangle or a table.
  template <typename X, typename C>
  static PistonTravel<X> other_travel(const X& theta, const Coefficients<C>& p) {
    if (p.law == TravelLaw::table) return table_travel(theta, p);
    return triangle_travel(X(theta - p.reference_angle_rad), p);
  }

  /// Fills in the pressures that are not given. If the reading puts the arm beyond a stop, moves it
  /// onto the stop, pressed in as far as the unbalanced pressures push it.
  template <typename C>
  static std::array<C, kStates> settled(std::array<C, kStates> x, const PlantInput<C>& in,
                                        const Coefficients<C>& p, const PresentTerms& terms,
                                        bool given_a, bool given_b) {
    const C D = lever(x[angle], p);
    C moment = gravity_moment(x[angle], p);
    if (terms.external_load) moment = moment + in.external_load;
    const C load = moment / D;  // as a force on the piston
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
