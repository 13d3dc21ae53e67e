#include "diagnosis/record/steady_leak.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "diagnosis/record/record_share.hpp"
#include "diagnosis/table/periodic_flow.hpp"

namespace rigcal::diagnosis {
namespace {

/// Computes the leak in the periodic state; empty if the rig does not become periodic.
std::optional<SteadyLeak> periodic(const calib::Problem& problem,
                                   const calib::ProblemCondition& condition,
                                   const model::ParameterValues& values, std::span<const int> free,
                                   const std::atomic<bool>* cancel, PeriodicEffort least) {
  const datasets::Condition& c = *condition.condition;
  PeriodicDrive drive;
  drive.rig = condition.rig;
  drive.signal.waveform = c.waveform;
  drive.signal.frequency_hz = *c.frequency_hz;
  drive.signal.amplitude = *c.amplitude;
  PeriodicOptions options;
  const auto& settings = problem.campaign->simulation;
  options.simulation.method = settings.method;
  options.simulation.tolerance = settings.tolerance.value_or(options.simulation.tolerance);
  options.simulation.max_seconds = settings.max_seconds;
  options.simulation.cancel = cancel;
  options.periods = std::max(options.periods, least.periods);
  options.intervals = std::max(options.intervals, least.intervals);
  const PeriodicFlow flow = periodic_flow(drive, values, free, options);
  if (!flow.ok()) return std::nullopt;
  SteadyLeak leak(flow.servo_flow_m3_per_s, flow.leak_flow_m3_per_s, flow.servo_slope,
                  flow.leak_slope);
  leak.is_periodic = true;
  leak.effort = {flow.periods, flow.intervals};
  return leak;
}

SteadyLeak over_record(const calib::Problem& problem, const calib::ProblemCondition& condition,
                       const model::ParameterValues& values, std::span<const int> free,
                       const std::atomic<bool>* cancel) {
  constexpr std::array kFlows{model::Output::servo_flow, model::Output::leakage_flow};
  const auto run =
      model::simulate(condition.rig, values, free, condition.inputs, condition.record->time_s,
                      kFlows, problem.simulation_options(cancel));
  if (!run.ok())
    throw NoResultError(fmt::format("condition \"{}\": share of the servo flow: {} at {:g} s",
                                    condition.condition->id, run.reason, run.failed_at_s));
  return leak_in_record(condition, run, 0);
}

}  // namespace

bool is_generated_wave(const datasets::Condition& condition) {
  return is_periodic(condition.waveform) && condition.frequency_hz.has_value();
}

bool has_periodic_state(const calib::ProblemCondition& condition) {
  const model::SimulationInputs& in = condition.inputs;
  return is_generated_wave(*condition.condition) && condition.condition->amplitude.has_value() &&
         !in.external_load && !in.supply_pressure_pa && !in.tank_pressure_pa &&
         !in.base_acceleration_m_per_s2 && !in.oil_temperature_k;
}

SteadyLeak steady_leak(const calib::Problem& problem, const calib::ProblemCondition& condition,
                       const model::ParameterValues& values, std::span<const int> free,
                       const std::atomic<bool>* cancel, PeriodicEffort least) {
  if (has_periodic_state(condition)) {
    if (auto leak = periodic(problem, condition, values, free, cancel, least)) return *leak;
  }
  return over_record(problem, condition, values, free, cancel);
}

}  // namespace rigcal::diagnosis
