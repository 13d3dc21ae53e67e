#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "model/controller.hpp"
#include "model/input_track.hpp"
#include "model/layout.hpp"
#include "model/plant_input.hpp"
#include "model/simulate.hpp"
#include "model/state.hpp"

namespace rigcal::model {

/// Plant, valve and controller as one system of N states with sensitivities to P parameters.
template <typename Plant, int N, int P>
class System {
 public:
  using C = Active<P>;
  using X = State<N, P>;
  using Parameters = typename Plant::template Parameters<C>;
  using Coefficients = typename Plant::template Coefficients<C>;

  /// @param free  table indices of the P (or fewer) parameters of the sensitivity columns
  System(const Layout& layout, const ParameterValues& values, std::span<const int> free,
         InputTrack drive, std::optional<InputTrack> external_force,
         std::optional<InputTrack> supply_pressure, std::optional<InputTrack> tank_pressure)
      : layout_(layout),
        drive_(std::move(drive)),
        external_force_(std::move(external_force)),
        supply_pressure_(std::move(supply_pressure)),
        tank_pressure_(std::move(tank_pressure)) {
    const auto& fields = Plant::template fields<C>();
    Parameters parameters;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      parameters.*(fields[i].member) = C(values.value[i]);
    }
    if constexpr (P > 0) {
      for (std::size_t j = 0; j < free.size(); ++j) {
        const auto& field = fields[static_cast<std::size_t>(free[j])];
        (parameters.*(field.member)).derivative.set(j, 1.0);
        if (field.spec.key == "transport_delay") delay_direction_ = static_cast<int>(j);
      }
    }
    parameters_ = Coefficients(parameters);
  }

  const Layout& layout() const { return layout_; }
  const Coefficients& parameters() const { return parameters_; }
  InputTrack& drive() { return drive_; }
  std::optional<InputTrack>& external_force() { return external_force_; }
  std::optional<InputTrack>& supply_pressure() { return supply_pressure_; }
  std::optional<InputTrack>& tank_pressure() { return tank_pressure_; }
  /// Sensitivity column of the transport delay among the P directions, or -1.
  int delay_direction() const { return delay_direction_; }

  [[gnu::flatten]] X derivative(const X& x, double t) const { return right_hand_side<C>(x, t); }

  Linearisation<N, P> linearise(const X& x, double t) const {
    using D = Dual<C, N + 1>;  // directions: the states, then time
    std::array<D, static_cast<std::size_t>(N)> lifted;
    for (int i = 0; i < N; ++i) {
      lifted[static_cast<std::size_t>(i)] = D::variable(x[static_cast<std::size_t>(i)], i);
    }
    const auto f = right_hand_side<D>(lifted, t);
    Linearisation<N, P> lin;
    for (std::size_t i = 0; i < N; ++i) {
      lin.f[i] = f[i].value;
      lin.f_t[i] = f[i].derivative[static_cast<std::size_t>(N)];
      for (std::size_t k = 0; k < N; ++k) lin.jacobian[i][k] = f[i].derivative[k];
    }
    return lin;
  }

  /// The sampled controller's tick at t.
  void tick(X& x, double t) const {
    const C error = input_value<C>(drive_, t, true) - x[Plant::position];
    controller_tick(error, x, parameters_, layout_);
  }

  /// Value of each wanted output, with sensitivities; sensors come after (sensors.hpp).
  void observe(const X& x, double t, std::span<const Output> outputs, std::span<C> result) const {
    C command{};
    PlantInput<C> in{};
    const bool of_states_alone = std::all_of(outputs.begin(), outputs.end(),
                                             [](Output output) { return Plant::state_of(output); });
    if (!of_states_alone) {
      command = valve_command(x, input_value<C>(drive_, t, true));
      in = plant_input<C>(x, command, t);
    }
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      switch (outputs[k]) {
        case Output::position:
          result[k] = x[Plant::position];
          break;
        case Output::velocity:
          result[k] = x[Plant::velocity];
          break;
        case Output::command:
          result[k] = command;
          break;
        default:
          result[k] = Plant::output(outputs[k], x, in, parameters_, layout_.terms);
      }
    }
  }

  /// State at the first sample.
  X initial(InitialState mode, double t) const {
    X states;
    states.fill(C(0.0));
    if (layout_.supply >= 0)
      states[static_cast<std::size_t>(layout_.supply)] = source_pressure<C>(t);
    const PlantInput<C> in = plant_input<C>(states, C(0.0), t);
    const bool given = mode == InitialState::given;
    const auto plant = given ? Plant::initial(in, parameters_, layout_.terms)
                             : Plant::rest(in, parameters_, layout_.terms);
    for (std::size_t i = 0; i < plant.size(); ++i) states[i] = plant[i];
    if constexpr (requires { parameters_.hose_yield_pa; }) {
      if (layout_.hoses >= 0) {
        const auto first = static_cast<std::size_t>(layout_.hoses);
        states[first] = Plant::hose_memory(plant[Plant::pressure_a], in);
        states[first + 1] = Plant::hose_memory(plant[Plant::pressure_b], in);
      }
    }
    if (given) {
      // The loop was closed before the record began: no kick of the derivative, spool at rest.
      const C drive = input_value<C>(drive_, t, true);
      if (layout_.filter >= 0) {
        states[static_cast<std::size_t>(layout_.filter)] = drive - plant[Plant::position];
      }
      if (layout_.sampled()) {
        states[static_cast<std::size_t>(layout_.held)] =
            controller_output(C(drive - plant[Plant::position]), states, parameters_, layout_)
                .limited;
      }
      if (layout_.valve_order > 0) {
        states[static_cast<std::size_t>(layout_.valve)] = valve_command(states, drive);
      }
    }
    return states;
  }

  /// States that the outputs are made of.
  static std::vector<std::size_t> observed_states(std::span<const Output> outputs) {
    std::vector<std::size_t> states;
    for (std::size_t i = 0; i < N; ++i) {
      const bool seen = std::any_of(outputs.begin(), outputs.end(), [i](Output output) {
        const auto state = Plant::state_of(output);
        return !state || static_cast<std::size_t>(*state) == i;
      });
      if (seen) states.push_back(i);
    }
    return states;
  }

 private:
  /// An input at one instant: with its time derivative where D has one, and with its derivative by
  /// the transport delay, -d/dt, where it is delayed and that is a direction.
  template <typename D>
  D input_value(const InputTrack& track, double t, bool delayed) const {
    if constexpr (std::is_same_v<D, C>) {
      if (!delayed || delay_direction_ < 0) return C(track.value(t));
      const SignalSample s = track.sample(t);
      return with_delay(s.value, s.slope);
    } else {
      const SignalSample s = track.sample(t);
      const bool moves = delayed && delay_direction_ >= 0;
      D value(moves ? with_delay(s.value, s.slope) : C(s.value));
      value.derivative.set(static_cast<std::size_t>(N),
                           moves ? with_delay(s.slope, s.curvature) : C(s.slope));
      return value;
    }
  }

  C with_delay(double value, double slope) const {
    C result(value);
    if constexpr (P > 0) {
      result.derivative.set(static_cast<std::size_t>(delay_direction_), -slope);
    }
    return result;
  }

  /// What the valve is told: the held output, the controller's, or the recorded command.
  template <typename D>
  D valve_command(const std::array<D, static_cast<std::size_t>(N)>& x, const D& drive) const {
    if (!layout_.pid) return drive;
    const D error = drive - x[Plant::position];
    if constexpr (N == Plant::kStates) {
      constexpr Layout kNoStates;
      return controller_output(error, x, parameters_, kNoStates).limited;
    } else {
      if (layout_.sampled()) return x[static_cast<std::size_t>(layout_.held)];
      return controller_output(error, x, parameters_, layout_).limited;
    }
  }

  template <typename D>
  PlantInput<D> plant_input(const std::array<D, static_cast<std::size_t>(N)>& x, const D& command,
                            double t) const {
    PlantInput<D> in;
    in.spool_command_v = command;
    if constexpr (N > Plant::kStates) {
      if (layout_.valve_order > 0) in.spool_command_v = x[static_cast<std::size_t>(layout_.valve)];
    }
    if (layout_.terms.external_force) {
      in.external_force_n = D(parameters_.external_force_n);
      if (external_force_)
        in.external_force_n = in.external_force_n + input_value<D>(*external_force_, t, false);
    }
    in.supply_pressure_pa =
        layout_.supply >= 0 ? x[static_cast<std::size_t>(layout_.supply)] : source_pressure<D>(t);
    if constexpr (requires { parameters_.tank_pressure_pa; }) {
      in.tank_pressure_pa = tank_pressure_ ? input_value<D>(*tank_pressure_, t, false)
                                           : D(parameters_.tank_pressure_pa);
    }
    return in;
  }

  /// Supply pressure before its resistance.
  template <typename D>
  D source_pressure(double t) const {
    return supply_pressure_ ? input_value<D>(*supply_pressure_, t, false)
                            : D(parameters_.supply_pressure_pa);
  }

  /// Rate of the spool signal within its limit [V/s].
  template <typename D>
  D spool_rate(const D& rate) const {
    return layout_.terms.valve_rate_limit
               ? clamp_symmetric(rate, parameters_.valve_rate_limit_v_per_s)
               : rate;
  }

  template <typename D>
  std::array<D, static_cast<std::size_t>(N)> right_hand_side(
      const std::array<D, static_cast<std::size_t>(N)>& x, double t) const {
    const D drive = input_value<D>(drive_, t, true);
    if constexpr (N == Plant::kStates) {
      const D command = valve_command(x, drive);
      return Plant::derivative(x, plant_input<D>(x, command, t), parameters_, layout_.terms);
    } else {
      return with_states_of_the_loop(x, drive, t);
    }
  }

  /// The derivative of valve, controller and plant together.
  template <typename D>
  std::array<D, static_cast<std::size_t>(N)> with_states_of_the_loop(
      const std::array<D, static_cast<std::size_t>(N)>& x, const D& drive, double t) const {
    const Coefficients& p = parameters_;
    std::array<D, static_cast<std::size_t>(N)> dx{};
    D command = drive;
    if (layout_.pid) {
      if (layout_.sampled()) {
        command = x[static_cast<std::size_t>(layout_.held)];
      } else {
        const D error = drive - x[Plant::position];
        const ControllerOutput<D> u = controller_output(error, x, p, layout_);
        command = u.limited;
        if (layout_.integral >= 0) {
          dx[static_cast<std::size_t>(layout_.integral)] = integral_rate(error, u, p);
        }
        if (layout_.filter >= 0) {
          const auto filter = static_cast<std::size_t>(layout_.filter);
          dx[filter] = (error - x[filter]) * p.derivative_filter_rad_per_s;
        }
      }
    }
    if (layout_.valve_order == 1) {
      const auto spool = static_cast<std::size_t>(layout_.valve);
      dx[spool] = spool_rate(D((command - x[spool]) / p.valve_time_constant_s));
    } else if (layout_.valve_order == 2) {
      const auto spool = static_cast<std::size_t>(layout_.valve);
      const C& omega = p.valve_frequency_rad_per_s;
      dx[spool] = spool_rate(x[spool + 1]);
      dx[spool + 1] = (command - x[spool]) * (omega * omega) -
                      x[spool + 1] * (2.0 * p.valve_damping_ratio * omega);
    }
    const PlantInput<D> in = plant_input<D>(x, command, t);
    const auto plant_dx = Plant::derivative(x, in, p, layout_.terms);
    for (std::size_t i = 0; i < plant_dx.size(); ++i) dx[i] = plant_dx[i];
    if constexpr (requires { p.hose_yield_pa; }) {
      if (layout_.hoses >= 0) {
        const auto rates = Plant::hose_rates(x, plant_dx, p, layout_.terms);
        dx[static_cast<std::size_t>(layout_.hoses)] = rates[0];
        dx[static_cast<std::size_t>(layout_.hoses) + 1] = rates[1];
      }
    }
    if constexpr (requires { p.supply_capacity_m3_per_pa; }) {
      if (layout_.supply >= 0) {
        const D inflow =
            (source_pressure<D>(t) - in.supply_pressure_pa) / p.supply_resistance_pa_s_per_m3;
        dx[static_cast<std::size_t>(layout_.supply)] =
            (inflow - Plant::supply_flow(x, in, p, layout_.terms)) / p.supply_capacity_m3_per_pa;
      }
    }
    return dx;
  }

  Layout layout_;
  Coefficients parameters_{};
  InputTrack drive_;
  std::optional<InputTrack> external_force_;
  std::optional<InputTrack> supply_pressure_;
  std::optional<InputTrack> tank_pressure_;
  int delay_direction_ = -1;
};

}  // namespace rigcal::model
