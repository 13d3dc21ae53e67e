#include "diagnosis/steady_leak.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include "calib/published/periodic_flow.hpp"
#include "metrics/leak_share.hpp"

namespace rigcal::diagnosis {
namespace {

bool is_periodic(const datasets::Condition& condition) {
  return (condition.waveform == datasets::Waveform::sine ||
          condition.waveform == datasets::Waveform::square) &&
         condition.frequency_hz.has_value();
}

/// Whether nothing but a generated wave drives the rig, so that there is a periodic state.
bool has_periodic_state(const calib::ProblemCondition& condition) {
  const model::SimulationInputs& in = condition.inputs;
  return is_periodic(*condition.condition) && condition.condition->amplitude.has_value() &&
         !in.external_force_n && !in.supply_pressure_pa && !in.tank_pressure_pa;
}

SteadyLeak with_slopes(double servo, double leak, const Eigen::VectorXd& servo_slope,
                       const Eigen::VectorXd& leak_slope) {
  SteadyLeak result;
  result.share = leak / servo;
  result.leak_flow_m3_per_s = leak;
  result.share_slope = (leak_slope - result.share * servo_slope) / servo;
  result.flow_slope = leak_slope;
  return result;
}

/// Empty where the rig does not become periodic.
std::optional<SteadyLeak> periodic(const calib::Problem& problem,
                                   const calib::ProblemCondition& condition,
                                   const model::ParameterValues& values,
                                   std::span<const int> free) {
  const datasets::Condition& c = *condition.condition;
  calib::PeriodicDrive drive;
  drive.rig = condition.rig;
  drive.signal.waveform = c.waveform;
  drive.signal.frequency_hz = *c.frequency_hz;
  drive.signal.amplitude = *c.amplitude;
  calib::PeriodicOptions options;
  const auto& settings = problem.campaign->simulation;
  options.simulation.method = settings.method;
  options.simulation.tolerance = settings.tolerance.value_or(options.simulation.tolerance);
  options.simulation.max_seconds = settings.max_seconds;
  const calib::PeriodicFlow flow = calib::periodic_flow(drive, values, free, options);
  if (!flow.ok()) return std::nullopt;
  SteadyLeak leak = with_slopes(flow.servo_flow_m3_per_s, flow.leak_flow_m3_per_s, flow.servo_slope,
                                flow.leak_slope);
  leak.is_periodic = true;
  return leak;
}

std::span<const double> counted(const Eigen::MatrixXd& matrix, Eigen::Index column,
                                const SteadyPart& part) {
  return {matrix.col(column).data() + part.first, part.count};
}

SteadyLeak over_record(const calib::Problem& problem, const calib::ProblemCondition& condition,
                       const model::ParameterValues& values, std::span<const int> free) {
  constexpr std::array kFlows{model::Output::servo_flow, model::Output::leakage_flow};
  const std::string& id = condition.condition->id;
  model::SimulationOptions options;
  options.method = problem.campaign->simulation.method;
  options.tolerance = problem.tolerance;
  options.max_seconds = problem.campaign->simulation.max_seconds;
  const auto& time_s = condition.record->time_s;
  const auto run =
      model::simulate(condition.rig, values, free, condition.inputs, time_s, kFlows, options);
  if (!run.ok())
    throw NoResultError(fmt::format("condition \"{}\": share of the servo flow: {} at {:g} s", id,
                                    run.reason, run.failed_at_s));
  const SteadyPart part = steady_part(condition);
  const auto times = std::span(time_s).subspan(part.first, part.count);
  const auto mean = [&](Eigen::Index column) {
    return metrics::mean_absolute(times, counted(run.outputs, column, part));
  };
  const auto slope = [&](Eigen::Index column) {
    const auto& matrix = run.sensitivities[static_cast<std::size_t>(column)];
    Eigen::VectorXd result(matrix.cols());
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      result(j) = metrics::mean_absolute_slope(times, counted(run.outputs, column, part),
                                               counted(matrix, j, part));
    }
    return result;
  };
  if (!(mean(0) > 0.0))
    throw NoResultError(fmt::format(
        "condition \"{}\": the simulated run moves no oil, so no share of it can leak", id));
  const Eigen::VectorXd none;
  return with_slopes(mean(0), mean(1), free.empty() ? none : slope(0),
                     free.empty() ? none : slope(1));
}

}  // namespace

SteadyPart steady_part(const calib::ProblemCondition& condition) {
  const std::vector<double>& time_s = condition.record->time_s;
  const std::size_t begin = condition.rows.front();
  const std::size_t end = condition.rows.back() + 1;
  const datasets::Condition& c = *condition.condition;
  if (!is_periodic(c)) return {begin, end - begin};
  const double period_s = 1.0 / *c.frequency_hz;
  const double span_s = time_s[end - 1] - time_s[begin];
  constexpr double kSlack = 1e-6;
  double periods = std::floor(span_s / period_s + kSlack);
  if (periods < 1.0) return {begin, end - begin};
  if (periods >= 3.0) periods -= 1.0;
  const double from_s = time_s[end - 1] - (periods + kSlack) * period_s;
  const auto first = std::lower_bound(time_s.begin(), time_s.end(), from_s) - time_s.begin();
  return {static_cast<std::size_t>(first), end - static_cast<std::size_t>(first)};
}

SteadyLeak steady_leak(const calib::Problem& problem, const calib::ProblemCondition& condition,
                       const model::ParameterValues& values, std::span<const int> free) {
  if (condition.rows.size() < 2) {
    throw NoResultError(
        fmt::format("condition \"{}\": one sample counts, and a share is of flows over a time; "
                    "expected at least 2",
                    condition.condition->id));
  }
  if (has_periodic_state(condition)) {
    if (auto leak = periodic(problem, condition, values, free)) return *leak;
  }
  return over_record(problem, condition, values, free);
}

}  // namespace rigcal::diagnosis
