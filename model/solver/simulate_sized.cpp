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

/// Typical size of a state near zero, as a multiple of its floor.
constexpr double kFloorsOfAState = 1e3;

/// Typical size of a parameter, which scales the error of its sensitivity.
double scale_of(const ParameterSpec& spec, double value) {
  if (value != 0.0) return std::abs(value);
  const double range = std::max(std::abs(spec.lower), std::abs(spec.upper));
  return std::isfinite(range) && range > 0.0 ? 1e-3 * range : 1.0;
}

/// The state from which a run continues. Each component whose sensitivity column is within
/// [first, first + count) is an independent variable.
template <int N, int P>
State<N, P> state_to_go_on_from(const SizedRequest& request, int first, int count) {
  State<N, P> x;
  x.fill(Active<P>(0.0));
  const Eigen::VectorXd& state = *request.state;
  const auto parameters = static_cast<int>(request.free.size());
  for (int i = 0; i < static_cast<int>(state.size()); ++i) {
    Active<P>& each = x[static_cast<std::size_t>(i)];
    each = Active<P>(state(i));
    const int column = parameters + i - first;
    if constexpr (P > 0) {
      if (column >= 0 && column < count) each.derivative.set(static_cast<std::size_t>(column), 1.0);
    }
  }
  return x;
}

/// Makes one pass with at most P sensitivity columns. The free parameters come first, then the
/// state from which the run continues.
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
  if (request.inputs.external_force_n) force = track(*request.inputs.external_force_n);
  if (request.inputs.supply_pressure_pa) supply = track(*request.inputs.supply_pressure_pa);
  if (request.inputs.tank_pressure_pa) tank = track(*request.inputs.tank_pressure_pa);
  if (request.inputs.spool_error) spool_error = track(*request.inputs.spool_error);
  if (request.inputs.base_acceleration_m_per_s2)
    base = track(*request.inputs.base_acceleration_m_per_s2);
  if (request.inputs.oil_temperature_k) temperature = track(*request.inputs.oil_temperature_k);
  const auto of_parameters = static_cast<int>(request.free.size());
  const int begin = std::min(first, of_parameters);
  const int end = std::min(first + count, of_parameters);
  const auto free =
      request.free.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin));
  std::array<double, static_cast<std::size_t>(P)> scale;
  scale.fill(1.0);
  const auto table = parameter_table(request.parameters.plant);
  for (std::size_t j = 0; j < free.size(); ++j) {
    const auto index = static_cast<std::size_t>(free[j]);
    scale[j] = scale_of(table[index], request.parameters.value[index]);
  }
  using ThisRun = Run<Plant, N, P>;
  const auto floors = ThisRun::floors(request.layout);
  for (int column = std::max(first, of_parameters); column < first + count; ++column) {
    const int i = column - of_parameters;
    scale[static_cast<std::size_t>(column - first)] = std::max(
        std::abs((*request.state)(i)), kFloorsOfAState * floors[static_cast<std::size_t>(i)]);
  }
  System<Plant, N, P> system(
      request.layout, request.parameters, free,
      InputTrack(request.inputs.drive, start_s, request.parameters["transport_delay"],
                 request.before, request.inputs.drive_begins_s),
      std::move(force), std::move(supply), std::move(tank), std::move(spool_error), std::move(base),
      std::move(temperature));
  State<N, P> start = system.initial(request.initial, request.before, 0.0);
  if (request.state != nullptr) {
    start = state_to_go_on_from<N, P>(request, first, count);
  } else if (request.before == Before::steady && !settle(system, floors, start)) {
    result.status = SimulationStatus::no_equilibrium;
    result.failed_at_s = start_s;
    result.reason = "the rig does not settle at the first value of its drive";
    return;
  }
  if (request.state == nullptr) system.forget_hoses(start, 0.0);
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
  const int columns = static_cast<int>(request.free.size()) +
                      (request.state != nullptr ? request.layout.states : 0);
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
