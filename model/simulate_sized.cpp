#include "model/simulate_sized.hpp"

#include <algorithm>
#include <cmath>

#include "model/run.hpp"
#include RIGCAL_PLANT_HEADER

#if !defined(RIGCAL_STATES) || !defined(RIGCAL_PLANT) || !defined(RIGCAL_INSTRUCTION_SET)
#error "compiled once per plant, number of states and instruction set: model/CMakeLists.txt"
#endif

namespace rigcal::model {
namespace {

/// Typical size of a parameter, for the error scale of its sensitivity.
double scale_of(const ParameterSpec& spec, double value) {
  if (value != 0.0) return std::abs(value);
  const double range = std::max(std::abs(spec.lower), std::abs(spec.upper));
  return std::isfinite(range) && range > 0.0 ? 1e-3 * range : 1.0;
}

/// One pass with the sensitivities to at most P of the free parameters.
template <typename Plant, int N, int P>
void pass(const SizedRequest& request, int first, int count, Simulation& result) {
  const double start_s = request.times_s.front();
  const auto track = [start_s](const Signal& signal, double delay_s) {
    return InputTrack(signal, start_s, delay_s);
  };
  std::optional<InputTrack> force;
  std::optional<InputTrack> supply;
  std::optional<InputTrack> tank;
  if (request.inputs.external_force_n) force = track(*request.inputs.external_force_n, 0.0);
  if (request.inputs.supply_pressure_pa) supply = track(*request.inputs.supply_pressure_pa, 0.0);
  if (request.inputs.tank_pressure_pa) tank = track(*request.inputs.tank_pressure_pa, 0.0);
  const auto free =
      request.free.subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(count));
  std::array<double, static_cast<std::size_t>(P)> scale;
  scale.fill(1.0);
  const auto table = parameter_table(request.parameters.plant);
  for (std::size_t j = 0; j < free.size(); ++j) {
    const auto index = static_cast<std::size_t>(free[j]);
    scale[j] = scale_of(table[index], request.parameters.value[index]);
  }
  System<Plant, N, P> system(request.layout, request.parameters, free,
                             track(request.inputs.drive, request.parameters["transport_delay"]),
                             std::move(force), std::move(supply), std::move(tank));
  Run<Plant, N, P> run(std::move(system), scale, request.times_s, request.outputs, request.options,
                       request.started);
  run(request.initial, result, first, count);
}

/// Passes until every free parameter had its turn: up to eight sensitivities at a time, four where
/// they suffice, or where so many states are rare and would take long to compile.
template <typename Plant, int N>
void passes(const SizedRequest& request, Simulation& result) {
  const int free = static_cast<int>(request.free.size());
  if (free == 0) return pass<Plant, N, 0>(request, 0, 0, result);
  for (int first = 0; first < free && result.ok();) {
    const int left = free - first;
    if constexpr (N > 8) {
      const int count = std::min(left, 4);
      pass<Plant, N, 4>(request, first, count, result);
      first += count;
    } else if (left <= 4) {
      pass<Plant, N, 4>(request, first, left, result);
      first += left;
    } else {
      const int count = std::min(left, 8);
      pass<Plant, N, 8>(request, first, count, result);
      first += count;
    }
  }
}

}  // namespace

template <typename Plant, int N, InstructionSet Set>
void simulate_sized(const SizedRequest& request, Simulation& result) {
  passes<Plant, N>(request, result);
}

template void simulate_sized<RIGCAL_PLANT, RIGCAL_STATES, InstructionSet::RIGCAL_INSTRUCTION_SET>(
    const SizedRequest&, Simulation&);

}  // namespace rigcal::model
