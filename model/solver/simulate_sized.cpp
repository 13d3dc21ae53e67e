#include "model/solver/simulate_sized.hpp"

#include <algorithm>
#include <cmath>

#include "model/solver/equilibrium.hpp"
#include "model/solver/run.hpp"
#include RIGCAL_PLANT_HEADER

#if !defined(RIGCAL_STATES) || !defined(RIGCAL_PLANT) || !defined(RIGCAL_INSTRUCTION_SET) || \
    !defined(RIGCAL_WIDTHS)
#error "compiled once per plant, number of states and instruction set: model/CMakeLists.txt"
#endif

namespace rigcal::model {
namespace {

/// Typical size of a parameter, which scales the error of its sensitivity.
double scale_of(const ParameterSpec& spec, double value) {
  if (value != 0.0) return std::abs(value);
  const double range = std::max(std::abs(spec.lower), std::abs(spec.upper));
  return std::isfinite(range) && range > 0.0 ? 1e-3 * range : 1.0;
}

/// Makes one pass with at most P sensitivity columns.
template <typename Plant, int N, int P>
void pass(const SizedRequest& request, int first, int count, Simulation& result) {
  const double start_s = request.times_s.front();
  const auto track = [start_s](const Signal& signal) { return InputTrack(signal, start_s, 0.0); };
  std::optional<InputTrack> force;
  std::optional<InputTrack> supply;
  std::optional<InputTrack> tank;
  std::optional<InputTrack> spool_error;
  std::optional<InputTrack> base;
  std::optional<InputTrack> temperature;
  if (request.inputs.external_load) force = track(*request.inputs.external_load);
  if (request.inputs.supply_pressure_pa) supply = track(*request.inputs.supply_pressure_pa);
  if (request.inputs.tank_pressure_pa) tank = track(*request.inputs.tank_pressure_pa);
  if (request.inputs.spool_error) spool_error = track(*request.inputs.spool_error);
  if (request.inputs.base_acceleration_m_per_s2)
    base = track(*request.inputs.base_acceleration_m_per_s2);
  if (request.inputs.oil_temperature_k) temperature = track(*request.inputs.oil_temperature_k);
  const auto free =
      request.free.subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(count));
  std::array<double, static_cast<std::size_t>(P)> scale;
  scale.fill(1.0);
  const auto table = parameter_table(request.parameters.plant);
  for (std::size_t j = 0; j < free.size(); ++j) {
    const auto index = static_cast<std::size_t>(free[j]);
    scale[j] = scale_of(table[index], request.parameters.value[index]);
  }
  using ThisRun = Run<Plant, N, P>;
  System<Plant, N, P> system(
      request.layout, request.parameters, free,
      InputTrack(request.inputs.drive, start_s, request.parameters["transport_delay"],
                 request.before, request.inputs.drive_begins_s),
      std::move(force), std::move(supply), std::move(tank), std::move(spool_error), std::move(base),
      std::move(temperature));
  State<N, P> start = system.initial(request.initial, request.before, 0.0);
  if (request.before == Before::steady && !settle(system, ThisRun::floors(request.layout), start)) {
    result.status = SimulationStatus::no_equilibrium;
    result.failed_at_s = start_s;
    result.reason = "the rig does not settle at the first value of its drive";
    return;
  }
  system.forget_hoses(start, 0.0);
  ThisRun run(std::move(system), scale, request.times_s, request.outputs, request.options,
              request.period, request.started);
  run(start, result, first, count);
}

/// Computes the columns from `first` on. Uses the first width that has room for all of them, or
/// else the last width.
///
/// @return  number of computed columns
template <typename Plant, int N, int Width, int... Wider>
int next_pass(const SizedRequest& request, int first, int left, Simulation& result) {
  if constexpr (sizeof...(Wider) > 0) {
    if (left > Width) return next_pass<Plant, N, Wider...>(request, first, left, result);
  }
  const int count = std::min(left, Width);
  pass<Plant, N, Width>(request, first, count, result);
  return count;
}

/// Makes passes until all sensitivity columns are computed.
template <typename Plant, int N>
void passes(const SizedRequest& request, Simulation& result) {
  const auto columns = static_cast<int>(request.free.size());
  if (columns == 0) return pass<Plant, N, 0>(request, 0, 0, result);
  for (int first = 0; first < columns && result.ok();)
    first += next_pass<Plant, N, RIGCAL_WIDTHS>(request, first, columns - first, result);
}

}  // namespace

template <typename Plant, int N, InstructionSet Set>
void simulate_sized(const SizedRequest& request, Simulation& result) {
  passes<Plant, N>(request, result);
}

template void simulate_sized<RIGCAL_PLANT, RIGCAL_STATES, InstructionSet::RIGCAL_INSTRUCTION_SET>(
    const SizedRequest&, Simulation&);

}  // namespace rigcal::model
