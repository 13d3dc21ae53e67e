#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "model/arithmetic/state.hpp"
#include "model/plant/controller.hpp"
#include "model/plant/lag.hpp"
#include "model/plant/layout.hpp"
#include "model/plant/plant_input.hpp"
#include "model/plant/rig.hpp"
#include "model/plant/warm_oil.hpp"
#include "model/signal/input_track.hpp"

namespace rigcal::model {

/// Plant, valve and controller as one system of N states, with sensitivities to P parameters.
template <typename Plant, int N, int P>
class System {
 public:
  using C = Active<P>;
  using X = State<N, P>;
  template <typename T>
  using Coefficients = typename Plant::template Coefficients<T>;

  /// @param free  table indices of the P or fewer parameters with a sensitivity column
  System(const Layout& layout, const ParameterValues& values, std::span<const int> free,
         InputTrack drive, std::optional<InputTrack> external_load,
         std::optional<InputTrack> supply_pressure, std::optional<InputTrack> tank_pressure,
         std::optional<InputTrack> spool_error = std::nullopt,
         std::optional<InputTrack> base_acceleration = std::nullopt,
         std::optional<InputTrack> oil_temperature = std::nullopt)
      : layout_(layout),
        drive_(std::move(drive)),
        external_load_(std::move(external_load)),
        supply_pressure_(std::move(supply_pressure)),
        tank_pressure_(std::move(tank_pressure)),
        spool_error_(std::move(spool_error)),
        base_acceleration_(std::move(base_acceleration)),
        oil_temperature_(layout.terms.temperature ? std::move(oil_temperature) : std::nullopt) {
    passive_ = coefficients<double>(values, free);
    if constexpr (P > 0) {
      active_ = coefficients<C>(values, free);
      for (std::size_t b = 0; b < kBlocks; ++b) {
        const std::size_t first = std::min(b * kBlock, free.size());
        const std::size_t count = std::min<std::size_t>(kBlock, free.size() - first);
        active_blocks_[b] = coefficients<Dual<kBlock>>(values, free.subspan(first, count));
      }
      const auto table = Plant::template fields<double>();
      for (std::size_t j = 0; j < free.size(); ++j) {
        const auto& spec = table[static_cast<std::size_t>(free[j])].spec;
        if (spec.key == "transport_delay") delay_direction_ = static_cast<int>(j);
      }
    }
  }

  const Layout& layout() const { return layout_; }
  const Coefficients<double>& parameters() const { return passive_; }
  InputTrack& drive() { return drive_; }
  std::optional<InputTrack>& external_load() { return external_load_; }
  std::optional<InputTrack>& supply_pressure() { return supply_pressure_; }
  std::optional<InputTrack>& tank_pressure() { return tank_pressure_; }
  std::optional<InputTrack>& spool_error() { return spool_error_; }
  std::optional<InputTrack>& base_acceleration() { return base_acceleration_; }
  std::optional<InputTrack>& oil_temperature() { return oil_temperature_; }
  /// Sensitivity column of the transport delay, among the P directions; -1 if there is none.
  int delay_direction() const { return delay_direction_; }

  /// Derivative of the states and, by the chain rule, of their sensitivities.
  [[gnu::flatten]] X derivative(const X& x, double t) const {
    return right_hand_side(ByParameters{}, x, t);
  }

  /// Derivative of the states without sensitivities.
  [[gnu::flatten]] Values<N> derivative_of_values(const Values<N>& x, double t) const {
    return right_hand_side(Plain{}, x, t);
  }

  /// Returns f and its partial derivatives with respect to states, time and parameters.
  Linearisation<N, P> linearise(const Values<N>& x, double t) const {
    Linearisation<N, P> lin = [&] {
      if constexpr (N <= Plant::kStates + 1) {
        return linearise_inlined(x, t);
      } else {
        return linearise_by_calls(x, t);
      }
    }();
    if (oil_temperature_) add_warming(x, t, lin);
    return lin;
  }

  /// Whether the drive acts only on controller and valve. The plant then sees only the states of
  /// the valve.
  bool drive_stops_at_valve() const { return N > Plant::kStates && layout_.valve_order > 0; }

  /// Updates a linearisation at (x, t) after a jump of a drive that acts only on controller and
  /// valve, by recomputing only their rows. This helps because a recorded command jumps at every
  /// sample.
  void follow_drive(const Values<N>& x, double t, Linearisation<N, P>& lin) const {
    if constexpr (N > Plant::kStates) {
      Numbers<ByStates> rates{};
      loop_rates(ByStates{}, lifted(x), input_value(ByStates{}, drive_, t, true), t, rates);
      for (std::size_t i = Plant::kStates; i < N; ++i) {
        if (is_of_loop(i)) take_row(rates[i], i, lin);
      }
      if constexpr (P > 0) {
        X by_parameters{};
        loop_rates(ByParameters{}, held<ByParameters>(x),
                   input_value(ByParameters{}, drive_, t, true), t, by_parameters);
        for (std::size_t i = Plant::kStates; i < N; ++i) {
          if (is_of_loop(i)) lin.f_p[i] = by_parameters[i].derivative;
        }
      }
    }
  }

  /// f and its derivatives for settle(). A sampled controller changes only at its ticks, so its
  /// rate is taken as the change at a tick divided by the sample time.
  Linearisation<N, P> linearise_settling(const Values<N>& x, double t) const {
    Linearisation<N, P> lin = linearise(x, t);
    if (!layout_.sampled()) return lin;
    const auto rates = tick_rates(ByStates{}, lifted(x), t);
    const auto by_parameters = tick_rates(ByParameters{}, held<ByParameters>(x), t);
    for (std::size_t i = Plant::kStates; i < N; ++i) {
      if (!layout_.of_controller(static_cast<int>(i))) continue;
      take_row(rates[i], i, lin);
      if constexpr (P > 0) lin.f_p[i] = by_parameters[i].derivative;
    }
    return lin;
  }

  /// Applies the sampled controller's tick at t.
  void tick(X& x, double t) const {
    const C drive = input_value(ByParameters{}, drive_, t, true);
    controller_tick(loop_error(ByParameters{}, x, drive, t), x, parameters_of(ByParameters{}),
                    layout_);
  }

  /// Output of a continuous controller at x, before and after its limit.
  ControllerOutput<double> control(const Values<N>& x, double t) const {
    const double drive = input_value(Plain{}, drive_, t, true);
    return controller_output(loop_error(Plain{}, x, drive, t), x, passive_, layout_);
  }

  /// Computes each requested output with its sensitivities. Sensors are applied later
  /// (sensors.hpp).
  void observe(const X& x, double t, std::span<const Output> outputs, std::span<C> result) const {
    C command{};
    PlantInput<C> in{};
    const bool of_states_alone = std::all_of(outputs.begin(), outputs.end(),
                                             [](Output output) { return Plant::state_of(output); });
    if (!of_states_alone) {
      command = valve_command(ByParameters{}, x, input_value(ByParameters{}, drive_, t, true), t);
      in = plant_input(ByParameters{}, x, command, t);
    }
    WarmParameters<std::remove_cvref_t<decltype(parameters_of(ByParameters{}))>> warm;
    const auto& p = with_oil(ByParameters{}, t, warm);
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      if (outputs[k] == (layout_.terms.pilot ? Output::pilot_pressure : Output::command)) {
        result[k] = command;
        continue;
      }
      if constexpr (requires { Plant::angle; }) {
        result[k] = Plant::output(outputs[k], x, in, p, layout_.terms);
        continue;
      }
      switch (outputs[k]) {
        case Output::position:
          result[k] = x[Plant::position];
          break;
        case Output::velocity:
          result[k] = x[Plant::velocity];
          break;
        case Output::acceleration:
          result[k] = measured_acceleration(ByParameters{}, x, in, t);
          break;
        case Output::payload_acceleration:
          result[k] = payload_acceleration(ByParameters{}, x);
          break;
        default:
          result[k] = Plant::output(outputs[k], x, in, p, layout_.terms);
      }
    }
  }

  /// State at the first sample. For Before::steady, it is the state from which settle() starts.
  /// Call forget_hoses() afterwards.
  X initial(InitialState mode, Before before, double t) {
    const Coefficients<C>& p = parameters_of(ByParameters{});
    X states;
    states.fill(C(0.0));
    if (layout_.supply >= 0)
      states[static_cast<std::size_t>(layout_.supply)] = source_pressure(ByParameters{}, t);
    const PlantInput<C> in = plant_input(ByParameters{}, states, C(0.0), t);
    const bool given = mode == InitialState::given;
    const auto plant =
        given ? Plant::initial(in, p, layout_.terms) : Plant::rest(in, p, layout_.terms);
    for (std::size_t i = 0; i < plant.size(); ++i) states[i] = plant[i];
    while_it_waits_ = C(0.0);
    // At rest the reference equals the measured value, and a generator rests there.
    const bool generates = layout_.feedback == Feedback::three_variable_acceleration;
    if (before == Before::rest && layout_.pid) {
      while_it_waits_ = C(0.0) - loop_error(ByParameters{}, states, C(0.0), t).error;
      const C& omega = p.reference_frequency_rad_per_s;
      if (generates) while_it_waits_ = while_it_waits_ * (omega * omega);
    }
    if (before == Before::steady) {
      while_it_waits_ = C(drive_.first_value());
      if (layout_.pid && controls_motion(layout_.feedback))
        states[Plant::position] = while_it_waits_;
    }
    if (layout_.payload >= 0) {  // starts as if it were fixed to the first mass
      const auto payload = static_cast<std::size_t>(layout_.payload);
      states[payload] = states[Plant::position];
      states[payload + 1] = states[Plant::velocity];
    }
    // Film and bristles start as if the motion had been steady for long.
    if constexpr (requires { Plant::piston_velocity(states, p); }) {
      const C v = Plant::piston_velocity(states, p);
      if (layout_.film >= 0)
        states[static_cast<std::size_t>(layout_.film)] =
            steady_film(v, p.film_velocity_m_per_s, p.friction_smoothing_m_per_s);
      if (layout_.bristles >= 0)
        states[static_cast<std::size_t>(layout_.bristles)] =
            sliding_friction_of<Plant>(states, p, layout_.terms) *
            smooth_sign(v, p.friction_smoothing_m_per_s);
    }
    if (given && layout_.integral >= 0)
      states[static_cast<std::size_t>(layout_.integral)] = p.initial_integral_v;
    if (layout_.reference >= 0)  // the filtered rate begins at zero
      states[static_cast<std::size_t>(layout_.reference)] = states[Plant::position];
    if (given || before == Before::steady) {
      // The loop was closed before the record began: the derivative action gives no kick, and the
      // spool is at rest.
      const C drive =
          before == Before::hold ? input_value(ByParameters{}, drive_, t, true) : while_it_waits_;
      if (layout_.reference >= 0 && !generates)
        states[static_cast<std::size_t>(layout_.reference)] = drive;
      const LoopError<C> loop = loop_error(ByParameters{}, states, drive, t);
      if (layout_.filter >= 0) states[static_cast<std::size_t>(layout_.filter)] = loop.error;
      if (layout_.sampled()) {
        states[static_cast<std::size_t>(layout_.held)] =
            controller_output(loop, states, p, layout_).limited;
      }
      if (layout_.valve_order > 0) {
        states[static_cast<std::size_t>(layout_.valve)] =
            valve_command(ByParameters{}, states, drive, t);
      }
    }
    return states;
  }

  /// Sets the memory of the hoses to its value after an instantaneous rise to their present
  /// pressure.
  void forget_hoses([[maybe_unused]] X& states, [[maybe_unused]] double t) const {
    [[maybe_unused]] const Coefficients<C>& p = parameters_of(ByParameters{});
    if constexpr (requires { Plant::kHoses; }) {
      if (layout_.hoses < 0) return;
      const PlantInput<C> in = plant_input(ByParameters{}, states, C(0.0), t);
      const auto first = static_cast<std::size_t>(layout_.hoses);
      states[first] = Plant::hose_memory(states[Plant::pressure_a], in);
      states[first + 1] = Plant::hose_memory(states[Plant::pressure_b], in);
    }
  }

  /// Indices of the states on which the outputs depend.
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
  // Modes of computing a right-hand side: plain numbers, or numbers with derivatives with respect
  // to all parameters, to a block of them, or to the states and time.
  struct Plain {
    using Number = double;
  };
  struct ByParameters {
    using Number = C;
  };
  struct ByStates {
    using Number = Dual<N + 1>;  ///< directions: the states, then time
  };
  /// Plain numbers, with an oil temperature above the recorded one.
  struct Warmer {
    using Number = double;
    double by_k;
  };
  static constexpr int kTime = N;
  static constexpr int kBlock = 4;
  static constexpr std::size_t kBlocks = P / kBlock;
  static_assert(P % kBlock == 0);
  /// Derivatives with respect to more parameters at a time would not fit into the registers.
  struct ByBlock {
    using Number = Dual<kBlock>;
    std::size_t block;  ///< block of parameters
  };
  template <typename K>
  using Number = typename K::Number;
  template <typename K>
  using Numbers = std::array<Number<K>, static_cast<std::size_t>(N)>;

  template <typename T>
  Coefficients<T> coefficients(const ParameterValues& values, std::span<const int> free) const {
    const auto& fields = Plant::template fields<T>();
    typename Plant::template Parameters<T> parameters;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      parameters.*(fields[i].member) = T(values.value[i]);
    }
    if constexpr (!std::is_same_v<T, double>) {
      for (std::size_t j = 0; j < free.size(); ++j) {
        const auto& field = fields[static_cast<std::size_t>(free[j])];
        (parameters.*(field.member)).derivative.set(j, 1.0);
      }
    }
    parameters.valve_time_constant_s = resolved_lag(parameters.valve_time_constant_s);
    if (layout_.pid) take_gains(layout_.feedback, parameters);
    if (layout_.terms.temperature && !oil_temperature_)
      warm_oil(parameters, parameters.oil_temperature_k);
    return Coefficients<T>(parameters);
  }

  /// The parameters with those of the oil at its recorded temperature.
  ///
  /// @param warm  space for them
  template <typename K>
  const auto& with_oil(K by, double t, auto& warm) const {
    if (!oil_temperature_) return parameters_of(by);
    return warmed(by, t, warm);
  }

  /// Not inlined, to keep the code of rigs without a recorded temperature short.
  template <typename K>
  [[gnu::noinline]] const auto& warmed(K by, double t, auto& warm) const {
    using T = std::remove_cvref_t<decltype(parameters_of(by).mass_kg)>;
    typename Plant::template Parameters<T> parameters = parameters_of(by);
    double temperature_k = oil_temperature_->value(t);
    if constexpr (std::is_same_v<K, Warmer>) temperature_k += by.by_k;
    warm_oil(parameters, T(temperature_k));
    return warm.emplace(parameters);
  }

  /// Adds the part of the time derivative that is due to the change of the recorded temperature. It
  /// is small and smooth, so a difference is as exact as the solver needs.
  [[gnu::noinline]] void add_warming(const Values<N>& x, double t, Linearisation<N, P>& lin) const {
    constexpr double kStep_k = 1e-3;
    const double slope = oil_temperature_->sample(t).slope;
    if (slope == 0.0) return;
    const Values<N> above = right_hand_side(Warmer{kStep_k}, x, t);
    const Values<N> below = right_hand_side(Warmer{-kStep_k}, x, t);
    for (std::size_t i = 0; i < N; ++i)
      lin.f_t[i] += slope * (above[i] - below[i]) / (2.0 * kStep_k);
  }

  /// The parameters, with derivatives if Number<K> has derivatives with respect to them.
  template <typename K>
  const auto& parameters_of([[maybe_unused]] K by) const {
    if constexpr (P > 0 && std::is_same_v<K, ByParameters>) {
      return active_;
    } else if constexpr (P > 0 && std::is_same_v<K, ByBlock>) {
      return active_blocks_[by.block];
    } else {
      return passive_;
    }
  }

  /// Index of the transport delay among the directions of a number; -1 if it is not one of them.
  int direction_of_delay(ByParameters /*by*/) const { return delay_direction_; }
  int direction_of_delay(ByBlock by) const {
    const int direction = delay_direction_ - kBlock * static_cast<int>(by.block);
    return direction < kBlock ? std::max(direction, -1) : -1;
  }

  /// Value of an input at one instant. It has a derivative with respect to time, or, for a delayed
  /// input, the derivative -d/dt with respect to the transport delay if that is a free parameter.
  template <typename K>
  Number<K> input_value(K by, const InputTrack& track, double t, bool delayed) const {
    if (delayed && track.waits()) return drive_that_waits(by);
    if constexpr (std::is_same_v<Number<K>, double>) {
      return track.value(t);
    } else if constexpr (!std::is_same_v<K, ByStates>) {
      const int direction = direction_of_delay(by);
      if (!delayed || direction < 0) return Number<K>(track.value(t));
      const SignalSample s = track.sample(t);
      Number<K> value(s.value);
      value.derivative.set(static_cast<std::size_t>(direction), -s.slope);
      return value;
    } else {
      const SignalSample s = track.sample(t);
      Number<K> value(s.value);
      value.derivative.set(kTime, s.slope);
      return value;
    }
  }

  /// Value of the drive before its first sample. Not inlined, because few simulations begin before
  /// it.
  template <typename K>
  [[gnu::noinline]] Number<K> drive_that_waits([[maybe_unused]] K by) const {
    if constexpr (std::is_same_v<K, ByParameters>) {
      return while_it_waits_;
    } else {
      Number<K> value(value_of(while_it_waits_));
      if constexpr (P > 0 && std::is_same_v<K, ByBlock>) {
        for (std::size_t i = 0; i < kBlock; ++i)
          value.derivative.set(i, while_it_waits_.derivative[by.block * kBlock + i]);
      }
      return value;
    }
  }

  /// Change of the states at a tick, divided by the sample time.
  template <typename K>
  Numbers<K> tick_rates(K by, const Numbers<K>& x, double t) const {
    const auto& p = parameters_of(by);
    Numbers<K> rates = x;
    controller_tick(loop_error(by, x, input_value(by, drive_, t, true), t), rates, p, layout_);
    for (std::size_t i = 0; i < N; ++i) rates[i] = (rates[i] - x[i]) / p.sample_time_s;
    return rates;
  }

  /// Whether loop_rates() computes the derivative of a state.
  bool is_of_loop(std::size_t i) const {
    const int state = static_cast<int>(i);
    return (layout_.of_controller(state) && state != layout_.held) ||
           (state >= layout_.valve &&
            state < layout_.valve + layout_.valve_order + (layout_.main_spool ? 1 : 0));
  }

  /// The states as independent variables, or as numbers with zero derivatives with respect to the
  /// parameters.
  static Numbers<ByStates> lifted(const Values<N>& x) {
    Numbers<ByStates> result;
    for (std::size_t i = 0; i < N; ++i) {
      result[i].value = x[i];
      result[i].derivative = Pack<N + 1>::unit(i);
    }
    return result;
  }
  template <typename K>
  static Numbers<K> held(const Values<N>& x) {
    Numbers<K> result;
    for (std::size_t i = 0; i < N; ++i) result[i] = x[i];
    return result;
  }
  static void take_row(const Number<ByStates>& f, std::size_t i, Linearisation<N, P>& lin) {
    lin.f[i] = f.value;
    lin.f_t[i] = f.derivative[kTime];
    for (std::size_t k = 0; k < N; ++k) lin.jacobian[i][k] = f.derivative[k];
  }

  /// Linearises with respect to states and time first, then with respect to the parameters.
  Linearisation<N, P> linearise_by_calls(const Values<N>& x, double t) const {
    const auto f = right_hand_side(ByStates{}, lifted(x), t);
    Linearisation<N, P> lin;
    for (std::size_t i = 0; i < N; ++i) take_row(f[i], i, lin);
    for (std::size_t block = 0; block < kBlocks; ++block) {
      const auto by_parameters = right_hand_side(ByBlock{block}, held<ByBlock>(x), t);
      for (std::size_t i = 0; i < N; ++i) put(by_parameters[i].derivative, block, lin.f_p[i]);
    }
    return lin;
  }

  /// Inlining everything saves an eighth of the time of a simulation with sensitivities. With more
  /// states, it would take too long to compile.
  [[gnu::flatten]] Linearisation<N, P> linearise_inlined(const Values<N>& x, double t) const {
    return linearise_by_calls(x, t);
  }

  /// Command to the valve: the sampled output, the controller's output, or the recorded command.
  template <typename K>
  Number<K> valve_command(K by, const Numbers<K>& x, const Number<K>& drive, double t) const {
    if (!layout_.pid) return drive;
    const auto& p = parameters_of(by);
    if constexpr (N == Plant::kStates) {
      constexpr Layout kNoStates;
      return with_limit(pid_output(Number<K>(drive - x[Plant::position]), x, p, kNoStates), p)
          .limited;
    } else {
      if (layout_.sampled()) return x[static_cast<std::size_t>(layout_.held)];
      if (!motion_alone_) return other_output(by, x, loop_error(by, x, drive, t)).limited;
      return with_limit(pid_output(Number<K>(drive - x[Plant::position]), x, p, layout_), p)
          .limited;
    }
  }

  /// Output of a loop that controls more than the motion. Not inlined, to keep the code of position
  /// loops short.
  template <typename K>
  [[gnu::noinline]] ControllerOutput<Number<K>> other_output(
      K by, const Numbers<K>& x, const LoopError<Number<K>>& loop) const {
    return controller_output(loop, x, parameters_of(by), layout_);
  }

  /// Signals on which the controller acts. The solver with only the plant's states supports only
  /// motion control.
  template <typename K>
  LoopError<Number<K>> loop_error(K by, const Numbers<K>& x, const Number<K>& drive,
                                  double t) const {
    if constexpr (N > Plant::kStates) {
      if (!motion_alone_) return other_loop_error(by, x, drive, t);
    }
    const Number<K> none(0.0);
    return {drive - x[Plant::position], none, none, none, none};
  }

  /// Not inlined, to keep the code of position loops short.
  template <typename K>
  [[gnu::noinline]] LoopError<Number<K>> other_loop_error(K by, const Numbers<K>& x,
                                                          const Number<K>& drive, double t) const {
    const auto& p = parameters_of(by);
    // Neither force nor torque nor load pressure nor acceleration depends on the spool, so the
    // command is not needed.
    const PlantInput<Number<K>> in = plant_input(by, x, Number<K>(0.0), t);
    const Number<K> none(0.0);
    LoopError<Number<K>> loop{drive, none, drive, none, none};
    switch (layout_.feedback) {
      case Feedback::position:
      case Feedback::angle:
        loop.error = drive - x[Plant::position];
        break;
      case Feedback::force:
        loop.error = drive - Plant::output(Output::force, x, in, p, layout_.terms);
        break;
      case Feedback::torque:
        loop.error = drive - Plant::output(Output::torque, x, in, p, layout_.terms);
        break;
      case Feedback::load_pressure:
        loop.error = drive - Plant::output(Output::load_pressure, x, in, p, layout_.terms);
        break;
      case Feedback::acceleration:
        loop.error = drive - measured_acceleration(by, x, in, t);
        break;
      case Feedback::three_variable:
      case Feedback::three_variable_acceleration:
        loop.error = x[static_cast<std::size_t>(layout_.reference)] - x[Plant::position];
        loop.velocity = x[static_cast<std::size_t>(layout_.rate)] - x[Plant::velocity];
        loop.acceleration =
            generated_acceleration(drive, x, p, layout_) - measured_acceleration(by, x, in, t);
        break;
    }
    if (layout_.pressure_feedback)
      loop.pressure_pa = Plant::output(Output::load_pressure, x, in, p, layout_.terms);
    return loop;
  }

  /// Acceleration of the piston relative to the ground [m/s2].
  template <typename K>
  Number<K> measured_acceleration(K by, const Numbers<K>& x, const PlantInput<Number<K>>& in,
                                  double t) const {
    WarmParameters<std::remove_cvref_t<decltype(parameters_of(by))>> warm;
    const Number<K> relative =
        Plant::derivative(x, in, with_oil(by, t, warm), layout_.terms)[Plant::velocity];
    if (!base_acceleration_) return relative;
    return relative + input_value(by, *base_acceleration_, t, false);
  }

  /// Acceleration of the second mass, with that of the base [m/s2].
  template <typename K>
  Number<K> payload_acceleration(K by, const Numbers<K>& x) const {
    if constexpr (N > Plant::kStates + 1) {
      if (layout_.payload >= 0)
        return model::payload_acceleration(x, Plant::position, layout_.terms, parameters_of(by));
    }
    return Number<K>(0.0);
  }

  template <typename K>
  PlantInput<Number<K>> plant_input(K by, const Numbers<K>& x, const Number<K>& command,
                                    double t) const {
    const auto& p = parameters_of(by);
    PlantInput<Number<K>> in;
    in.spool_command_v = command;
    if constexpr (N > Plant::kStates) {
      if (layout_.valve_order > 0) in.spool_command_v = x[static_cast<std::size_t>(layout_.valve)];
    }
    if (spool_error_) in.spool_command_v = with_spool_error(by, in.spool_command_v, t);
    if (layout_.terms.external_load) {
      in.external_load = Number<K>(p.external_force_n);
      if (external_load_)
        in.external_load = in.external_load + input_value(by, *external_load_, t, false);
      if (base_acceleration_) in.external_load = with_inertia_of_base(by, in.external_load, t);
    }
    in.supply_pressure_pa =
        layout_.supply >= 0 ? x[static_cast<std::size_t>(layout_.supply)] : source_pressure(by, t);
    if constexpr (requires { p.tank_pressure_pa; }) {
      in.tank_pressure_pa = tank_pressure_ ? input_value(by, *tank_pressure_, t, false)
                                           : Number<K>(p.tank_pressure_pa);
    }
    return in;
  }

  // The next two are not inlined, to keep the code of rigs without these inputs short.

  template <typename K>
  [[gnu::noinline]] Number<K> with_spool_error(K by, Number<K> spool_command_v, double t) const {
    return spool_command_v + input_value(by, *spool_error_, t, false);
  }

  /// Adds the inertia of the moved mass, in the frame of the base.
  template <typename K>
  [[gnu::noinline]] Number<K> with_inertia_of_base(K by, Number<K> force_n, double t) const {
    return force_n + input_value(by, *base_acceleration_, t, false) * parameters_of(by).mass_kg;
  }

  /// Supply pressure upstream of the supply resistance.
  template <typename K>
  Number<K> source_pressure(K by, double t) const {
    return supply_pressure_ ? input_value(by, *supply_pressure_, t, false)
                            : Number<K>(parameters_of(by).supply_pressure_pa);
  }

  /// Rate of the spool signal, limited to its maximum [V/s].
  template <typename K>
  Number<K> spool_rate(K by, const Number<K>& rate) const {
    return layout_.terms.valve_rate_limit
               ? clamp_symmetric(rate, parameters_of(by).valve_rate_limit_v_per_s)
               : rate;
  }

  template <typename K>
  Numbers<K> right_hand_side(K by, const Numbers<K>& x, double t) const {
    const Number<K> drive = input_value(by, drive_, t, true);
    if constexpr (N == Plant::kStates) {
      const Number<K> command = valve_command(by, x, drive, t);
      WarmParameters<std::remove_cvref_t<decltype(parameters_of(by))>> warm;
      return Plant::derivative(x, plant_input(by, x, command, t), with_oil(by, t, warm),
                               layout_.terms);
    } else {
      return with_states_of_the_loop(by, x, drive, t);
    }
  }

  /// Writes the derivatives of controller and valve, and leaves the others unchanged.
  ///
  /// @return  command to the valve
  template <typename K>
  Number<K> loop_rates(K by, const Numbers<K>& x, const Number<K>& drive, double t,
                       Numbers<K>& dx) const {
    const auto& p = parameters_of(by);
    Number<K> command = drive;
    if (layout_.pid) {
      if (layout_.sampled()) {
        command = x[static_cast<std::size_t>(layout_.held)];
      } else {
        if (motion_alone_) {
          const Number<K> error = drive - x[Plant::position];
          const auto u = with_limit(pid_output(error, x, p, layout_), p);
          pid_rates(by, x, error, u, dx);
          command = u.limited;
        } else {
          command = other_loop_rates(by, x, drive, t, dx);
        }
      }
    }
    if (layout_.valve_order > 0) {
      const auto spool = static_cast<std::size_t>(layout_.valve);
      if (layout_.main_spool) {
        lag_rates(by, x, pilot_command(by, x, command), spool + 1, dx);
        dx[spool] = x[spool + 1] * p.main_spool_gain_per_s;
      } else {
        lag_rates(by, x, command, spool, dx);
        dx[spool] = spool_rate(by, dx[spool]);
      }
    }
    return command;
  }

  /// Writes the derivatives of integral and filter.
  template <typename K>
  void pid_rates(K by, const Numbers<K>& x, const Number<K>& error,
                 const ControllerOutput<Number<K>>& u, Numbers<K>& dx) const {
    const auto& p = parameters_of(by);
    if (layout_.integral >= 0)
      dx[static_cast<std::size_t>(layout_.integral)] = integral_rate(error, u, p);
    if (layout_.filter >= 0) {
      const auto filter = static_cast<std::size_t>(layout_.filter);
      dx[filter] = (error - x[filter]) * p.derivative_filter_rad_per_s;
    }
  }

  /// Writes the derivatives of the controller of a loop that controls more than the motion. Not
  /// inlined, to keep the code of position loops short.
  ///
  /// @return  command to the valve
  template <typename K>
  [[gnu::noinline]] Number<K> other_loop_rates(K by, const Numbers<K>& x, const Number<K>& drive,
                                               double t, Numbers<K>& dx) const {
    const auto& p = parameters_of(by);
    const LoopError<Number<K>> loop = loop_error(by, x, drive, t);
    const auto u = controller_output(loop, x, p, layout_);
    pid_rates(by, x, loop.error, u, dx);
    if (layout_.reference >= 0)
      dx[static_cast<std::size_t>(layout_.reference)] = reference_rate(loop, x, p, layout_);
    if (layout_.rate >= 0)
      dx[static_cast<std::size_t>(layout_.rate)] = reference_acceleration(loop, x, p, layout_);
    return u.limited;
  }

  /// Writes the derivatives of the valve's lag of first or second order.
  ///
  /// @param first  index of the state that follows the command
  template <typename K>
  void lag_rates(K by, const Numbers<K>& x, const Number<K>& command, std::size_t first,
                 Numbers<K>& dx) const {
    const auto& p = parameters_of(by);
    if (layout_.valve_order == 1) {
      dx[first] = (command - x[first]) / p.valve_time_constant_s;
      return;
    }
    const auto& omega = p.valve_frequency_rad_per_s;
    dx[first] = x[first + 1];
    dx[first + 1] = (command - x[first]) * (omega * omega) -
                    x[first + 1] * (2.0 * p.valve_damping_ratio * omega);
  }

  /// Command to the pilot stage [V]: the command of the main spool minus its position. The fully
  /// open pilot moves the main spool at its rate limit.
  template <typename K>
  Number<K> pilot_command(K by, const Numbers<K>& x, const Number<K>& command) const {
    const auto& p = parameters_of(by);
    const Number<K> lacks = command - x[static_cast<std::size_t>(layout_.valve)];
    if (!layout_.terms.valve_rate_limit) return lacks;
    using Known = std::remove_cvref_t<decltype(p.main_spool_gain_per_s)>;
    return clamp_symmetric(lacks, Known(p.valve_rate_limit_v_per_s / p.main_spool_gain_per_s));
  }

  /// The derivative of valve, controller and plant together.
  template <typename K>
  Numbers<K> with_states_of_the_loop(K by, const Numbers<K>& x, const Number<K>& drive,
                                     double t) const {
    WarmParameters<std::remove_cvref_t<decltype(parameters_of(by))>> warm;
    const auto& p = with_oil(by, t, warm);
    Numbers<K> dx{};
    const Number<K> command = loop_rates(by, x, drive, t, dx);
    const PlantInput<Number<K>> in = plant_input(by, x, command, t);
    const auto plant_dx = Plant::derivative(x, in, p, layout_.terms);
    for (std::size_t i = 0; i < plant_dx.size(); ++i) dx[i] = plant_dx[i];
    if constexpr (N > Plant::kStates + 1) {
      if (layout_.payload >= 0) {
        const auto payload = static_cast<std::size_t>(layout_.payload);
        dx[payload] = x[payload + 1];
        dx[payload + 1] = payload_acceleration(by, x);
        if (base_acceleration_)
          dx[payload + 1] = dx[payload + 1] - input_value(by, *base_acceleration_, t, false);
      }
    }
    if constexpr (requires { Plant::piston_velocity(x, p); }) {
      if (layout_.bristles >= 0)
        dx[static_cast<std::size_t>(layout_.bristles)] =
            bristle_rate_of<Plant>(x, p, layout_.terms);
      if (layout_.film >= 0)
        dx[static_cast<std::size_t>(layout_.film)] = film_rate_of<Plant>(x, p, layout_.terms);
    }
    if constexpr (requires { Plant::kHoses; }) {
      if (layout_.hoses >= 0) {
        const auto rates = Plant::hose_rates(x, plant_dx, p, layout_.terms);
        dx[static_cast<std::size_t>(layout_.hoses)] = rates[0];
        dx[static_cast<std::size_t>(layout_.hoses) + 1] = rates[1];
      }
    }
    if constexpr (requires { Plant::supply_flow(x, in, p, layout_.terms); }) {
      if (layout_.supply >= 0) {
        dx[static_cast<std::size_t>(layout_.supply)] =
            Plant::supply_rate(source_pressure(by, t), Plant::supply_flow(x, in, p, layout_.terms),
                               x, in, p, layout_.terms);
      }
    }
    if constexpr (requires { p.pump_delay_s; }) {
      if (layout_.pump >= 0)
        dx[static_cast<std::size_t>(layout_.pump)] = Plant::demand_rate(x, in, p, layout_.terms);
    }
    return dx;
  }

  Layout layout_;
  bool motion_alone_ = layout_.motion_alone();  ///< read at every right-hand side
  Coefficients<double> passive_{};
  Coefficients<C> active_{};  ///< with derivatives with respect to the free parameters
  std::array<Coefficients<Dual<kBlock>>, kBlocks>
      active_blocks_{};  ///< the same coefficients, in blocks of free parameters
  InputTrack drive_;
  std::optional<InputTrack> external_load_;
  std::optional<InputTrack> supply_pressure_;
  std::optional<InputTrack> tank_pressure_;
  std::optional<InputTrack> spool_error_;
  std::optional<InputTrack> base_acceleration_;  ///< [m/s2]
  std::optional<InputTrack> oil_temperature_;    ///< [K]; only if the model has that term
  int delay_direction_ = -1;
  C while_it_waits_{0.0};  ///< value of the drive before its first sample
};

}  // namespace rigcal::model
