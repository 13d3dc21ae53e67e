#pragma once

#include "model/arithmetic/smooth.hpp"
#include "model/plant/layout.hpp"

namespace rigcal::model {

/// Output of the PID before and after its limit [V].
template <typename X>
struct ControllerOutput {
  X wanted{};
  X limited{};
};

/// Copies the gains of a force, pressure, acceleration, angle or torque loop to the members from
/// which the controller reads the gains of a position loop. The controller uses the same equations
/// for every loop; the gains are in V per unit of the controlled quantity.
template <typename P>
void take_gains(Feedback feedback, P& p) {
  switch (feedback) {
    case Feedback::position:
    case Feedback::three_variable:
    case Feedback::three_variable_acceleration:
      return;
    case Feedback::force:
      p.kp_v_per_m = p.force_kp_v_per_n;
      p.ki_v_per_m_s = p.force_ki_v_per_n_s;
      p.kd_v_s_per_m = p.force_kd_v_s_per_n;
      return;
    case Feedback::load_pressure:
      p.kp_v_per_m = p.load_pressure_kp_v_per_pa;
      p.ki_v_per_m_s = p.load_pressure_ki_v_per_pa_s;
      p.kd_v_s_per_m = p.load_pressure_kd_v_s_per_pa;
      return;
    case Feedback::acceleration:
      p.kp_v_per_m = p.acceleration_kp_v_s2_per_m;
      p.ki_v_per_m_s = p.acceleration_ki_v_s_per_m;
      p.kd_v_s_per_m = p.acceleration_kd_v_s3_per_m;
      return;
    case Feedback::angle:
      if constexpr (requires { p.angle_kp_v_per_rad; }) {
        p.kp_v_per_m = p.angle_kp_v_per_rad;
        p.ki_v_per_m_s = p.angle_ki_v_per_rad_s;
        p.kd_v_s_per_m = p.angle_kd_v_s_per_rad;
        p.velocity_feedforward_v_s_per_m = p.angular_velocity_feedforward_v_s_per_rad;
        p.acceleration_feedforward_v_s2_per_m = p.angular_acceleration_feedforward_v_s2_per_rad;
      }
      return;
    case Feedback::torque:
      if constexpr (requires { p.torque_kp_v_per_n_m; }) {
        p.kp_v_per_m = p.torque_kp_v_per_n_m;
        p.ki_v_per_m_s = p.torque_ki_v_per_n_m_s;
        p.kd_v_s_per_m = p.torque_kd_v_s_per_n_m;
      }
      return;
  }
}

/// The signals on which the controller acts.
template <typename X>
struct LoopError {
  X error{};         ///< reference minus controlled quantity, in the unit of that quantity
  X pressure_pa{};   ///< load pressure, if it is fed back
  X reference{};     ///< reference, if its rate is fed forward or a generator filters it
  X velocity{};      ///< error of the velocity in three-variable control [m/s]
  X acceleration{};  ///< the same for the acceleration [m/s2]
};

/// Acceleration of the reference generator [m/s2]: a_r = d - 2 zeta_r omega_r v_r - omega_r^2 x_r,
/// d = omega_r^2 r for a position r, or d = a for an acceleration a.
template <typename X, typename State, typename P>
X generated_acceleration(const X& reference, const State& state, const P& p, const Layout& layout) {
  const auto& omega = p.reference_frequency_rad_per_s;
  const X drive =
      layout.feedback == Feedback::three_variable ? X(reference * (omega * omega)) : reference;
  return drive -
         state[static_cast<std::size_t>(layout.rate)] * (2.0 * p.reference_damping_ratio * omega) -
         state[static_cast<std::size_t>(layout.reference)] * (omega * omega);
}

/// Rate of the filtered reference [m/s]: v_f = N (r - r_f), or v_r of a generator.
template <typename X, typename State, typename P>
X reference_rate(const LoopError<X>& loop, const State& state, const P& p, const Layout& layout) {
  if (layout.generator) return X(state[static_cast<std::size_t>(layout.rate)]);
  return (loop.reference - state[static_cast<std::size_t>(layout.reference)]) *
         p.derivative_filter_rad_per_s;
}

/// Rate of v_f after a second pass through the same filter [m/s2]: a_f = N (v_f - v_ff), or a_r of
/// a generator.
template <typename X, typename State, typename P>
X reference_acceleration(const LoopError<X>& loop, const State& state, const P& p,
                         const Layout& layout) {
  if (layout.generator) return generated_acceleration(loop.reference, state, p, layout);
  return (reference_rate(loop, state, p, layout) - state[static_cast<std::size_t>(layout.rate)]) *
         p.derivative_filter_rad_per_s;
}

/// Computes K_p e + I + K_d N (e - e_f), the complete control law of a motion loop.
///
/// @param state  the whole state vector; `layout` has the indices of integral and filter
template <typename X, typename State, typename P>
X pid_output(const X& error, const State& state, const P& p, const Layout& layout) {
  X wanted = error * p.kp_v_per_m;
  if (layout.integral >= 0) wanted = wanted + state[static_cast<std::size_t>(layout.integral)];
  if (layout.filter >= 0) {
    wanted = wanted + (error - state[static_cast<std::size_t>(layout.filter)]) *
                          (p.kd_v_s_per_m * p.derivative_filter_rad_per_s);
  }
  return wanted;
}

template <typename X, typename P>
ControllerOutput<X> with_limit(const X& wanted, const P& p) {
  return {wanted, clamp_symmetric(wanted, p.output_limit_v)};
}

/// Computes u = K_p e + I + K_d N (e - e_f) - K_dp P_L + K_vf v_f + K_af a_f, and limits it.
/// Three-variable control has K_v e_v + K_pa e_a in place of the third term.
///
/// @param state  the whole state vector; `layout` has the indices of integral and filter
template <typename X, typename State, typename P>
ControllerOutput<X> controller_output(const LoopError<X>& loop, const State& state, const P& p,
                                      const Layout& layout) {
  X wanted = pid_output(loop.error, state, p, layout);
  if (layout.generator)
    wanted = wanted + loop.velocity * p.velocity_kp_v_s_per_m +
             loop.acceleration * p.acceleration_kp_v_s2_per_m;
  if (layout.pressure_feedback) wanted = wanted - loop.pressure_pa * p.pressure_feedback_v_per_pa;
  if (layout.reference >= 0)
    wanted = wanted + reference_rate(loop, state, p, layout) * p.velocity_feedforward_v_s_per_m;
  if (layout.rate >= 0)
    wanted = wanted +
             reference_acceleration(loop, state, p, layout) * p.acceleration_feedforward_v_s2_per_m;
  return with_limit(wanted, p);
}

/// Rate at which back-calculation pulls a saturated integral back to the limit [1/s]: K_i / K_p.
/// The tracking time constant is then the integral time (Astrom and Hagglund, 1995). A purely
/// integral controller is pulled back within 10 ms.
template <typename P>
auto anti_windup_rate(const P& p) {
  using C = std::remove_cvref_t<decltype(p.kp_v_per_m)>;
  if (value_of(p.kp_v_per_m) > 0.0) return C(p.ki_v_per_m_s / p.kp_v_per_m);
  return C(100.0);
}

/// Time derivative of the integral [V/s] under back-calculation.
template <typename X, typename P>
X integral_rate(const X& error, const ControllerOutput<X>& u, const P& p) {
  return error * p.ki_v_per_m_s + (u.limited - u.wanted) * anti_windup_rate(p);
}

/// Advances the reference generator by backward Euler, and the errors with it.
template <typename X, typename State, typename P>
void generator_tick(LoopError<X>& loop, State& state, const P& p, const Layout& layout) {
  const auto& omega = p.reference_frequency_rad_per_s;
  const double period_s = value_of(p.sample_time_s);
  auto& position = state[static_cast<std::size_t>(layout.reference)];
  auto& rate = state[static_cast<std::size_t>(layout.rate)];
  const X before = generated_acceleration(loop.reference, state, p, layout);
  const X gained = (before - rate * (omega * omega * period_s)) /
                   (1.0 + omega * (2.0 * p.reference_damping_ratio * period_s) +
                    omega * omega * period_s * period_s);
  rate = rate + gained * period_s;
  position = position + rate * period_s;
  loop.error = loop.error + rate * period_s;
  loop.velocity = loop.velocity + gained * period_s;
  loop.acceleration = loop.acceleration + (gained - before);
}

/// One tick of the sampled controller. The filters advance by backward Euler, the integral by
/// forward Euler with the same back-calculation, and the output is constant until the next tick.
/// Back-calculation takes at least one period to reach the limit, so the integral cannot overshoot.
template <typename X, typename State, typename P>
void controller_tick(LoopError<X> loop, State& state, const P& p, const Layout& layout) {
  const X& error = loop.error;
  const double period_s = value_of(p.sample_time_s);
  const auto follow = [&](int index, const X& value) {
    auto& filtered = state[static_cast<std::size_t>(index)];
    const X step = X(p.derivative_filter_rad_per_s * period_s);
    filtered = (filtered + step * value) / (1.0 + step);
  };
  if (layout.filter >= 0) follow(layout.filter, error);
  if (layout.generator) {
    generator_tick(loop, state, p, layout);
  } else {
    if (layout.reference >= 0) follow(layout.reference, loop.reference);
    if (layout.rate >= 0) follow(layout.rate, reference_rate(loop, state, p, layout));
  }
  const ControllerOutput<X> u = controller_output(loop, state, p, layout);
  if (layout.integral >= 0) {
    auto& integral = state[static_cast<std::size_t>(layout.integral)];
    auto pull = anti_windup_rate(p) * period_s;
    if (value_of(pull) > 1.0) pull = 1.0;
    integral = integral + error * (p.ki_v_per_m_s * period_s) + (u.limited - u.wanted) * pull;
  }
  state[static_cast<std::size_t>(layout.held)] = u.limited;
}

}  // namespace rigcal::model
