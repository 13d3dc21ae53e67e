#pragma once

#include <array>
#include <optional>
#include <span>
#include <type_traits>

#include "model/controller.hpp"
#include "model/input_track.hpp"
#include "model/layout.hpp"
#include "model/load_pressure.hpp"
#include "model/rosenbrock.hpp"
#include "model/simulate.hpp"

namespace rigcal::model {

/// A number with the derivatives by P parameters; a plain double for none.
template <int P>
using Active = std::conditional_t<P == 0, double, Dual<double, P>>;

template <int P>
Active<P> active_row(const double* row) {
  if constexpr (P == 0) {
    return *row;
  } else {
    Active<P> a(row[0]);
    for (std::size_t j = 0; j < P; ++j) a.derivative[j] = row[1 + j];
    return a;
  }
}

template <int P>
void store_row(const Active<P>& a, double* row) {
  if constexpr (P == 0) {
    *row = a;
  } else {
    row[0] = a.value;
    for (std::size_t j = 0; j < P; ++j) row[1 + j] = a.derivative[j];
  }
}

/// Plant, valve and controller as one system of N states with sensitivities to P parameters.
template <typename Plant, int N, int P>
class System {
 public:
  using C = Active<P>;
  using State = StateMatrix<N, P>;
  using States = std::array<C, static_cast<std::size_t>(N)>;
  using Parameters = typename Plant::template Parameters<C>;

  /// @param free  table indices of the P (or fewer) parameters of the sensitivity columns
  System(const Layout& layout, const ParameterValues& values, std::span<const int> free,
         InputTrack drive, std::optional<InputTrack> external_force,
         std::optional<InputTrack> supply_pressure)
      : layout_(layout),
        drive_(std::move(drive)),
        external_force_(std::move(external_force)),
        supply_pressure_(std::move(supply_pressure)) {
    const auto& fields = Plant::template fields<C>();
    for (std::size_t i = 0; i < fields.size(); ++i) {
      parameters_.*(fields[i].member) = C(values.value[i]);
    }
    if constexpr (P > 0) {
      for (std::size_t j = 0; j < free.size(); ++j) {
        const auto& field = fields[static_cast<std::size_t>(free[j])];
        (parameters_.*(field.member)).derivative[j] = 1.0;
        if (field.spec.key == "transport_delay") delay_direction_ = static_cast<int>(j);
      }
    }
  }

  const Layout& layout() const { return layout_; }
  const Parameters& parameters() const { return parameters_; }
  InputTrack& drive() { return drive_; }
  std::optional<InputTrack>& external_force() { return external_force_; }
  std::optional<InputTrack>& supply_pressure() { return supply_pressure_; }
  /// Sensitivity column of the transport delay among the P directions, or -1.
  int delay_direction() const { return delay_direction_; }

  State derivative(const State& x, double t) const {
    return pack(right_hand_side<C>(unpack(x), t));
  }

  Linearisation<N, P> linearise(const State& x, double t) const {
    using X = Dual<C, N + 1>;  // directions: the states, then time
    const States states = unpack(x);
    std::array<X, static_cast<std::size_t>(N)> lifted;
    for (int i = 0; i < N; ++i) {
      lifted[static_cast<std::size_t>(i)] = X::variable(states[static_cast<std::size_t>(i)], i);
    }
    const auto f = right_hand_side<X>(lifted, t);
    Linearisation<N, P> lin;
    for (int i = 0; i < N; ++i) {
      const X& fi = f[static_cast<std::size_t>(i)];
      store_row<P>(fi.value, row(lin.f, i));
      store_row<P>(fi.derivative[static_cast<std::size_t>(N)], row(lin.f_t, i));
      for (int k = 0; k < N; ++k) {
        const C& slope = fi.derivative[static_cast<std::size_t>(k)];
        lin.jacobian(i, k) = value_of(slope);
        if constexpr (P > 0) {
          for (std::size_t j = 0; j < P; ++j) {
            lin.jacobian_tangent[j](i, k) = slope.derivative[j];
          }
        }
      }
    }
    return lin;
  }

  /// The sampled controller's tick at t.
  void tick(State& x, double t) const {
    States states = unpack(x);
    const C error = input_value<C>(drive_.sample(t), true) - states[Plant::position];
    controller_tick(error, states, parameters_, layout_);
    x = pack(states);
  }

  /// Value of each wanted output, with sensitivities.
  void observe(const State& x, double t, std::span<const Output> outputs,
               std::span<C> result) const {
    const States states = unpack(x);
    const C drive = input_value<C>(drive_.sample(t), true);
    const C command = valve_command(states, drive);
    const PlantInput<C> in = plant_input<C>(states, command, t);
    std::array<C, Plant::kStates> plant;
    for (std::size_t i = 0; i < plant.size(); ++i) plant[i] = states[i];
    const Parameters& p = parameters_;
    const C& P_L = plant[Plant::load_pressure];
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      switch (outputs[k]) {
        case Output::position:
          result[k] = plant[Plant::position] + p.position_offset_m;
          break;
        case Output::velocity:
          result[k] = plant[Plant::velocity];
          break;
        case Output::load_pressure:
          result[k] = P_L + p.load_pressure_offset_pa;
          break;
        case Output::pressure_a:
          result[k] = 0.5 * (in.supply_pressure_pa + P_L) + p.pressure_a_offset_pa;
          break;
        case Output::pressure_b:
          result[k] = 0.5 * (in.supply_pressure_pa - P_L) + p.pressure_b_offset_pa;
          break;
        case Output::force:
          result[k] = Plant::rod_force(plant, p, layout_.terms) + p.force_offset_n;
          break;
        case Output::command:
          result[k] = command;
          break;
        case Output::spool:
          result[k] = Plant::spool(in, p);
          break;
        case Output::servo_flow:
          result[k] = Plant::servo_flow(P_L, in, p);
          break;
        case Output::leakage_flow:
          result[k] = Plant::leakage_flow(P_L, p, layout_.terms);
          break;
        case Output::work_flow:
          result[k] = plant[Plant::velocity] * p.piston_area_m2;
          break;
      }
    }
  }

  /// State at the first sample.
  State initial(InitialState mode, double t) const {
    States states;
    states.fill(C(0.0));
    if (mode == InitialState::given) {
      const auto plant = Plant::initial(parameters_, layout_.initial_pressure_given);
      for (std::size_t i = 0; i < plant.size(); ++i) states[i] = plant[i];
      // The loop was closed before the record began: no kick of the derivative, spool at rest.
      const C drive = input_value<C>(drive_.sample(t), true);
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
    return pack(states);
  }

  static States unpack(const State& x) {
    States states;
    for (int i = 0; i < N; ++i) states[static_cast<std::size_t>(i)] = active_row<P>(row(x, i));
    return states;
  }
  static State pack(const States& states) {
    State x;
    for (int i = 0; i < N; ++i) store_row<P>(states[static_cast<std::size_t>(i)], row(x, i));
    return x;
  }

 private:
  static const double* row(const State& x, int i) { return x.data() + i * (1 + P); }
  static double* row(State& x, int i) { return x.data() + i * (1 + P); }

  /// An input at one instant: with its time derivative where X has one, and with its derivative by
  /// the transport delay, -d/dt, where it is delayed and that is a direction.
  template <typename X>
  X input_value(const SignalSample& s, bool delayed) const {
    if constexpr (std::is_same_v<X, C>) {
      C value(s.value);
      if constexpr (P > 0) {
        if (delayed && delay_direction_ >= 0) {
          value.derivative[static_cast<std::size_t>(delay_direction_)] = -s.slope;
        }
      }
      return value;
    } else {
      X value(input_value<C>(s, delayed));
      value.derivative[static_cast<std::size_t>(N)] =
          input_value<C>({s.slope, s.curvature, 0.0}, delayed);
      return value;
    }
  }

  /// What the valve is told: the held output, the controller's, or the recorded command.
  template <typename X>
  X valve_command(const std::array<X, static_cast<std::size_t>(N)>& x, const X& drive) const {
    if (!layout_.pid) return drive;
    if (layout_.sampled()) return x[static_cast<std::size_t>(layout_.held)];
    return controller_output(X(drive - x[Plant::position]), x, parameters_, layout_).limited;
  }

  template <typename X>
  PlantInput<X> plant_input(const std::array<X, static_cast<std::size_t>(N)>& x, const X& command,
                            double t) const {
    PlantInput<X> in;
    in.spool_command_v =
        layout_.valve_order == 0 ? command : x[static_cast<std::size_t>(layout_.valve)];
    if (external_force_) in.external_force_n = input_value<X>(external_force_->sample(t), false);
    in.supply_pressure_pa = supply_pressure_ ? input_value<X>(supply_pressure_->sample(t), false)
                                             : X(parameters_.supply_pressure_pa);
    return in;
  }

  template <typename X>
  std::array<X, static_cast<std::size_t>(N)> right_hand_side(
      const std::array<X, static_cast<std::size_t>(N)>& x, double t) const {
    const Parameters& p = parameters_;
    std::array<X, static_cast<std::size_t>(N)> dx{};
    const X drive = input_value<X>(drive_.sample(t), true);
    X command = drive;
    if (layout_.pid) {
      if (layout_.sampled()) {
        command = x[static_cast<std::size_t>(layout_.held)];
      } else {
        const X error = drive - x[Plant::position];
        const ControllerOutput<X> u = controller_output(error, x, p, layout_);
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
      dx[spool] = (command - x[spool]) / p.valve_time_constant_s;
    } else if (layout_.valve_order == 2) {
      const auto spool = static_cast<std::size_t>(layout_.valve);
      const C& omega = p.valve_frequency_rad_per_s;
      dx[spool] = x[spool + 1];
      dx[spool + 1] = (command - x[spool]) * (omega * omega) -
                      x[spool + 1] * (2.0 * p.valve_damping_ratio * omega);
    }
    std::array<X, Plant::kStates> plant;
    for (std::size_t i = 0; i < plant.size(); ++i) plant[i] = x[i];
    const auto plant_dx = Plant::derivative(plant, plant_input<X>(x, command, t), p, layout_.terms);
    for (std::size_t i = 0; i < plant.size(); ++i) dx[i] = plant_dx[i];
    return dx;
  }

  Layout layout_;
  Parameters parameters_{};
  InputTrack drive_;
  std::optional<InputTrack> external_force_;
  std::optional<InputTrack> supply_pressure_;
  int delay_direction_ = -1;
};

}  // namespace rigcal::model
