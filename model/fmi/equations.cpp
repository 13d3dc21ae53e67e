#include "model/fmi/equations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "model/fmi/indicators.hpp"
#include "model/plant/system.hpp"
#include "model/solver/equilibrium.hpp"
#include "model/solver/error_norm.hpp"
#include "model/solver/rosenbrock.hpp"

namespace rigcal::model {
namespace {

constexpr double kDoubleEpsilon = std::numeric_limits<double>::epsilon();

InputTrack track(const Ramp& ramp, double length_s) {
  if (ramp.slope_per_s == 0.0) return {Signal::constant(ramp.value), 0.0, 0.0};
  const double end = ramp.value + ramp.slope_per_s * length_s;
  return {Signal::linear({0.0, length_s}, {ramp.value, end}), 0.0, 0.0};
}

/// @tparam N  room for the states of the layout; unused ones stay zero
template <typename Plant, int N>
class SizedEquations final : public Equations {
 public:
  using Sys = System<Plant, N, 0>;

  explicit SizedEquations(const ExportedRig& rig)
      : initial_(rig.rig.initial),
        before_(rig.rig.before),
        layout_(exported_layout(rig)),
        system_(system(rig.values, {}, 1.0)) {}

  const Layout& layout() const override { return layout_; }

  void set(const ParameterValues& values, const RigInputs& inputs, double length_s) override {
    values_ = values;
    inputs_ = inputs;
    system_ = system(values, inputs, length_s);
  }

  std::vector<double> initial() const override {
    // The equilibrium depends on the load. A plant that slides reads it from the parameters, which
    // a joint lacks.
    ParameterValues values = values_;
    std::optional<InputTrack> load;
    if (parameter_index(values.plant, "external_force") >= 0)
      values.set("external_force", inputs_.external_load.value);
    else
      load = track(inputs_.external_load, 1.0);
    Sys system(layout_, values, {}, track(inputs_.drive, 1.0), std::move(load),
               track(inputs_.supply_pressure_pa, 1.0), track(inputs_.tank_pressure_pa, 1.0));
    Values<N> state = system.initial(initial_, before_, 0.0);
    if (before_ == Before::steady &&
        !settle(system, state_floors<Plant, static_cast<std::size_t>(N)>(layout_), state))
      throw std::runtime_error("the rig does not settle at the first value of its drive");
    system.forget_hoses(state, 0.0);
    return shortened(state);
  }

  std::vector<double> derivatives(std::span<const double> x) const override {
    return shortened(system_.derivative_of_values(padded(x), 0.0));
  }

  double output(Output output, std::span<const double> x) const override {
    double value = 0.0;
    system_.observe(padded(x), 0.0, {&output, 1}, {&value, 1});
    return value;
  }

  std::vector<double> indicators(std::span<const double> x) const override {
    const Values<N> state = padded(x);
    const auto& p = system_.parameters();
    const double command_v =
        output(layout_.terms.pilot ? Output::pilot_pressure : Output::command, x);
    const double spool_v =
        layout_.valve_order > 0 ? state[static_cast<std::size_t>(layout_.valve)] : command_v;
    std::vector<double> indicators;
    plant_indicators(p, layout_.terms, state, system_.derivative_of_values(state, 0.0), spool_v,
                     indicators);
    friction_indicators<Plant>(p, layout_.terms, state, indicators);
    loop_indicators(p, layout_, state, system_.control(state, 0.0).wanted, command_v, indicators);
    return indicators;
  }

  void tick(std::span<double> x, double time_s) const override {
    Values<N> state = padded(x);
    system_.tick(state, time_s);
    std::copy_n(state.begin(), x.size(), x.begin());
  }

  void advance(std::vector<double>& x, StepMemory& memory, double from_s, double to_s,
               double tolerance) const override {
    Values<N> peak = state_floors<Plant, static_cast<std::size_t>(N)>(layout_);
    for (std::size_t i = 0; i < memory.peak.size(); ++i)
      peak[i] = std::max(peak[i], memory.peak[i]);
    ErrorNorm<N, 0> norm(layout_.states, peak, {}, tolerance, 1.0);
    Rosenbrock<N, 0> rosenbrock;
    Values<N> state = padded(x);
    norm.see(state);
    double t = from_s;
    double h = memory.planned_step_s > 0.0 ? memory.planned_step_s : first_step(state, norm, t);
    for (long steps = 0; t < to_s;) {
      const auto lin = system_.linearise(state, t);
      for (bool accepted = false; !accepted;) {
        if (++steps > kMostSteps) fail("too many steps", h);
        const bool cut_short = t + h > to_s - 1e-3 * h;
        const double step = cut_short ? to_s - t : h;
        Values<N> next;
        Values<N> error;
        rosenbrock.do_step(system_, lin, state, t, next, step, error);
        const double size = norm.of_states(error, next);
        accepted = size <= 1.0;
        if (accepted) {
          t = cut_short ? to_s : t + step;
          h = cut_short ? std::max(h, step * factor(size)) : step * factor(size);
          state = next;
          norm.see(state);
          for (std::size_t i = 0; i < N; ++i) peak[i] = std::max(peak[i], std::abs(state[i]));
        } else {
          h = step * std::min(factor(size), 0.9);
          if (h < 16.0 * kDoubleEpsilon * std::max(t, 1e-3))
            fail(std::isfinite(size) ? "the step size vanishes" : "the state is no longer finite",
                 h);
        }
      }
    }
    x = shortened(state);
    memory.peak = shortened(peak);
    memory.planned_step_s = h;
  }

 private:
  /// Step limit for one communication step of the importer, so that each one ends.
  static constexpr long kMostSteps = 5'000'000;

  /// Includes terms whose parameter an importer may change from zero, even if they are zero now.
  static Layout exported_layout(const ExportedRig& rig) {
    const std::vector<int> parameters = exported_parameters(rig);
    return layout_of(rig.rig, rig.values, parameters, Plant::kStates, true);
  }

  Sys system(ParameterValues values, const RigInputs& inputs, double length_s) const {
    if (parameter_index(values.plant, "external_force") >= 0)
      values.set("external_force", 0.0);  // the input replaces it
    return {layout_,
            values,
            {},
            track(inputs.drive, length_s),
            track(inputs.external_load, length_s),
            track(inputs.supply_pressure_pa, length_s),
            track(inputs.tank_pressure_pa, length_s)};
  }

  static Values<N> padded(std::span<const double> x) {
    Values<N> state{};
    std::copy(x.begin(), x.end(), state.begin());
    return state;
  }

  std::vector<double> shortened(const Values<N>& state) const {
    return {state.begin(), state.begin() + layout_.states};
  }

  static double factor(double error) {
    if (!std::isfinite(error)) return 0.1;
    return std::clamp(0.9 * inverse_fourth_root(std::max(error, 1e-10)), 0.2, 5.0);
  }

  double first_step(const Values<N>& state, const ErrorNorm<N, 0>& norm, double t) const {
    Values<N> small{};
    add_scaled(small, 1e-6, system_.derivative_of_values(state, t));
    const double error = norm.of_states(small, state);
    return error > 0.0 && std::isfinite(error) ? std::max(1e-9, 1e-6 * std::pow(error, -0.25))
                                               : 1e-6;
  }

  [[noreturn]] static void fail(const char* what, double h) {
    throw std::runtime_error(std::string("the solver fails at steps of ") + std::to_string(h) +
                             " s: " + what);
  }

  InitialState initial_;
  Before before_;
  Layout layout_;
  ParameterValues values_;
  RigInputs inputs_;
  Sys system_;
};

/// Uses the first compiled size that has room for all states.
template <typename Plant, int N, int... Larger>
std::unique_ptr<Equations> sized(const ExportedRig& rig) {
  const Layout layout = layout_of(rig.rig, rig.values, {}, Plant::kStates, true);
  if (layout.states <= N) return std::make_unique<SizedEquations<Plant, N>>(rig);
  if constexpr (sizeof...(Larger) > 0) return sized<Plant, Larger...>(rig);
  throw std::logic_error("a layout with an unexpected number of states");
}

}  // namespace

std::unique_ptr<Equations> make_equations(const ExportedRig& rig) {
  switch (rig.rig.plant) {
    case PlantKind::load_pressure:
      return sized<LoadPressurePlant, 5, 10>(rig);
    case PlantKind::two_chamber:
      return sized<TwoChamberPlant, 5, 12>(rig);
    case PlantKind::linkage:
      return sized<LinkagePlant, 8>(rig);
  }
  throw std::logic_error("no such plant");
}

}  // namespace rigcal::model
