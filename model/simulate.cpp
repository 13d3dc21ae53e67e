#include "model/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "model/arithmetic/subnormals.hpp"
#include "model/plant/layout.hpp"
#include "model/plant/plants.hpp"
#include "model/signal/same_instant.hpp"
#include "model/solver/sampled_period.hpp"
#include "model/solver/sensors.hpp"
#include "model/solver/simulate_sized.hpp"

namespace rigcal::model {
namespace {

/// Describes the first parameter in use that is not finite or outside its limits; empty if there is
/// none. A second-order valve needs its damping ratio, a derivative action its filter, oil that
/// follows its temperature a temperature, and a joint its lever: none of them has a default.
std::string bad_parameter(const ParameterValues& values, const Layout& layout,
                          const SimulationInputs& inputs) {
  const auto table = parameter_table(values.plant);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const ParameterSpec& spec = table[i];
    const bool in_use =
        values.given[i] || spec.kind == ParameterKind::plant ||
        (layout.valve_order == 2 && spec.key == "valve_damping_ratio") ||
        (layout.payload >= 0 && spec.key == "payload_frequency") ||
        (layout.filter >= 0 && spec.key == "derivative_filter") ||
        (layout.terms.temperature && !inputs.oil_temperature_k && spec.key == "oil_temperature") ||
        (spec.key == "lever" && !values.is_given("triangle_base") &&
         !values.is_given("travel_table_to") && !values.is_given("displacement_per_radian")) ||
        ((spec.key == "area_a" || spec.key == "area_b") &&
         !values.is_given("displacement_per_radian")) ||
        (spec.key == "triangle_arm" && values.is_given("triangle_base")) ||
        (layout.generator &&
         (spec.key == "reference_frequency" || spec.key == "reference_damping_ratio"));
    if (!in_use) continue;
    const double v = values.value[i];
    if (!(v >= spec.lower && v <= spec.upper)) {
      return fmt::format("{} = {:g} {} is outside [{:g}, {:g}]", spec.key, v, spec.unit, spec.lower,
                         spec.upper);
    }
  }
  return {};
}

void require(bool condition, const char* message) {
  if (!condition) throw std::invalid_argument(std::string("simulate: ") + message);
}

/// Calls a function object with the type of a plant as template argument.
template <std::size_t I = 0, typename Function>
decltype(auto) with_plant(PlantKind plant, const Function& function) {
  if (static_cast<std::size_t>(plant) == I)
    return function.template operator()<std::tuple_element_t<I, Plants>>();
  if constexpr (I + 1 < kPlantCount) return with_plant<I + 1>(plant, function);
  throw std::logic_error("simulate: no such plant");
}

int plant_states(PlantKind plant) {
  return with_plant(plant, []<typename Plant>() { return Plant::kStates; });
}

/// Whether reversing the inputs reverses all requested outputs.
bool reversible(PlantKind plant, const PresentTerms& terms, std::span<const Output> outputs) {
  return with_plant(plant, [&]<typename Plant>() {
    return std::all_of(outputs.begin(), outputs.end(),
                       [&terms](Output output) { return Plant::reversible(output, terms); });
  });
}

/// The numbers of states for which solvers of a plant were compiled (CMakeLists.txt), in ascending
/// order.
template <typename Plant, int... States>
struct Sized {};
template <typename... PerPlant>
struct Solvers : PerPlant... {};
using BaseSolvers = Solvers<RIGCAL_base_SOLVERS>;
#ifdef RIGCAL_WITH_AVX2
using Avx2Solvers = Solvers<RIGCAL_avx2_SOLVERS>;
#endif

/// Finds the sizes compiled for a plant. A call for a plant without any does not compile.
template <typename Plant, int... States>
std::integer_sequence<int, States...> sizes_of(const Sized<Plant, States...>& solvers);

template <int... States>
constexpr int largest(std::integer_sequence<int, States...> /*sizes*/) {
  return std::max({States...});
}

/// Number of states for which the largest solver of a plant has room. It is the same with every
/// instruction set.
int largest_room(PlantKind plant) {
  return with_plant(plant, []<typename Plant>() {
    return largest(decltype(sizes_of<Plant>(std::declval<const BaseSolvers&>()))());
  });
}

/// Runs the first solver that has room for all states.
template <typename Plant, InstructionSet Set, int N, int... Larger>
void run(std::integer_sequence<int, N, Larger...>, const SizedRequest& request,
         Simulation& result) {
  // The smallest solver has only the plant's states and supports only position loops.
  const bool takes_all = N > Plant::kStates || request.layout.motion_alone();
  if (request.layout.states <= N && takes_all)
    return simulate_sized<Plant, N, Set>(request, result);
  if constexpr (sizeof...(Larger) > 0) {
    run<Plant, Set>(std::integer_sequence<int, Larger...>{}, request, result);
  } else {
    throw std::logic_error("simulate: a layout with an unexpected number of states");
  }
}

void dispatch(const SizedRequest& request, Simulation& result) {
  using enum InstructionSet;
  const SubnormalsAreZero while_it_runs;
  with_plant(request.parameters.plant, [&]<typename Plant>() {
#ifdef RIGCAL_WITH_AVX2
    if constexpr (requires(const Avx2Solvers& all) { sizes_of<Plant>(all); }) {
      using Sizes = decltype(sizes_of<Plant>(std::declval<const Avx2Solvers&>()));
      if (best_instruction_set() == avx2) return run<Plant, avx2>(Sizes(), request, result);
    }
#endif
    using Sizes = decltype(sizes_of<Plant>(std::declval<const BaseSolvers&>()));
    run<Plant, base>(Sizes(), request, result);
  });
}

}  // namespace

InstructionSet best_instruction_set() {
#ifdef RIGCAL_WITH_AVX2
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return InstructionSet::avx2;
#endif
  return InstructionSet::base;
}

namespace {

/// Does what Eigen's allFinite() does, but faster: allFinite() tests one number at a time. Eigen's
/// sum() is slower, too, because each addition waits for the previous one.
bool all_finite(const Eigen::MatrixXd& values) {
  constexpr Eigen::Index kSums = 16;
  Eigen::Array<double, kSums, 1> sums = Eigen::Array<double, kSums, 1>::Zero();
  const Eigen::Index whole = values.size() / kSums * kSums;
  for (Eigen::Index i = 0; i < whole; i += kSums)
    sums += 0.0 * Eigen::Map<const Eigen::Array<double, kSums, 1>>(values.data() + i);
  const Eigen::Map<const Eigen::ArrayXd> rest(values.data() + whole, values.size() - whole);
  return sums.sum() + (0.0 * rest).sum() == 0.0;
}

/// Whether an input changes too fast for two instants to be distinguished. No solver could follow
/// it.
bool too_fast(const SimulationInputs& inputs, std::span<const double> times_s) {
  constexpr double kInstants = 4.0;
  constexpr double kMostEdges = 16.0;  // number of edges of a waveform in one period
  const double least_s = kInstants * same_instant_s(times_s);
  const auto fast = [least_s](const std::optional<Signal>& signal) {
    if (!signal) return false;
    const double period_s = signal->period_s().value_or(0.0);
    return signal->max_step() < least_s || (period_s > 0.0 && period_s < kMostEdges * least_s);
  };
  return fast(inputs.drive) || fast(inputs.external_load) || fast(inputs.supply_pressure_pa) ||
         fast(inputs.tank_pressure_pa) || fast(inputs.spool_error) ||
         fast(inputs.base_acceleration_m_per_s2) || fast(inputs.oil_temperature_k);
}

}  // namespace

StateCount count_states(const Rig& rig, const ParameterValues& parameters) {
  return {layout_of(rig, parameters, {}, plant_states(rig.plant)).states, largest_room(rig.plant)};
}

Simulation simulate(const Rig& rig, const ParameterValues& parameters, std::span<const int> free,
                    const SimulationInputs& inputs, std::span<const double> times_s,
                    std::span<const Output> outputs, const SimulationOptions& options) {
  const auto started = std::chrono::steady_clock::now();
  options.validate();
  const auto table = parameter_table(rig.plant);
  require(parameters.plant == rig.plant && parameters.value.size() == table.size(),
          "parameters belong to another plant");
  require(!times_s.empty(), "no sample times");
  require(std::isfinite(times_s.front()) && std::isfinite(times_s.back()),
          "sample times must be finite");
  const auto late = std::adjacent_find(times_s.begin(), times_s.end(),
                                       [](double t, double next) { return !(next > t); });
  require(late == times_s.end(), "sample times must increase");
  for (const int index : free) {
    require(index >= 0 && index < static_cast<int>(table.size()), "free: no such parameter");
    require(table[static_cast<std::size_t>(index)].can_be_fitted, "free: cannot be fitted");
  }

  Simulation result;
  const Layout layout =
      layout_of(rig, parameters, free, plant_states(rig.plant),
                inputs.external_load.has_value() || inputs.base_acceleration_m_per_s2.has_value());
  result.reason = bad_parameter(parameters, layout, inputs);
  if (!result.reason.empty()) {
    result.status = SimulationStatus::bad_parameters;
    result.failed_at_s = times_s.front();
    return result;
  }
  if (too_fast(inputs, times_s)) {
    result.status = SimulationStatus::step_too_small;
    result.failed_at_s = times_s.front();
    result.reason = "an input changes faster than its sample times resolve";
    return result;
  }
  const std::optional<SensorTimes> at = sensor_times(outputs, parameters, free, times_s);
  const std::span<const double> at_s = at ? std::span<const double>(at->times_s) : times_s;
  const auto samples = static_cast<Eigen::Index>(at_s.size());
  // Left uninitialised, because a successful simulation writes all elements.
  result.outputs.resize(samples, static_cast<Eigen::Index>(outputs.size()));
  result.sensitivities.resize(outputs.size());
  // Allocated here and not in the solver: memory that code for AVX2 allocates must not be freed by
  // code for other processors.
  for (Eigen::MatrixXd& each : result.sensitivities)
    each.resize(samples, static_cast<Eigen::Index>(free.size()));
  std::optional<SampledPeriod> period;
  if (options.periodic_steady_state) {
    const std::optional<double> tick_s =
        layout.sampled() ? std::optional(parameters["sample_time"]) : std::nullopt;
    period = sampled_period(inputs, at_s, reversible(rig.plant, layout.terms, outputs), tick_s);
    // For each remaining period, extrapolation sums over all of them, so its cost grows with the
    // square of their number.
    constexpr std::size_t kMostPeriods = 20'000;
    if (period && at_s.size() / period->samples > kMostPeriods) period.reset();
    // While the rig still waits for its drive, it does not change, but it is not yet in its
    // periodic steady state.
    if (period && rig.before != Before::hold &&
        parameters["transport_delay"] > 0.5 * period->duration_s)
      period.reset();
  }
  dispatch({layout, rig.initial, rig.before, parameters, free, inputs, at_s, outputs, options,
            period, started},
           result);
  if (result.ok()) read_sensors(at, outputs, parameters, free, result);
  const bool finite =
      all_finite(result.outputs) &&
      std::all_of(result.sensitivities.begin(), result.sensitivities.end(), all_finite);
  if (result.ok() && !finite) {
    result.status = SimulationStatus::not_finite;
    result.failed_at_s = times_s.back();
    result.reason = "an output or a sensitivity is not finite";
  }
  if (!result.ok()) {
    result.outputs.resize(0, 0);
    result.sensitivities.clear();
  }
  return result;
}

}  // namespace rigcal::model
