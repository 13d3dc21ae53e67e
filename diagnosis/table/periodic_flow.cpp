#include "diagnosis/table/periodic_flow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "diagnosis/table/period_grid.hpp"
#include "metrics/mean_absolute.hpp"

namespace rigcal::diagnosis {
namespace {

using model::Output;
constexpr std::array kOutputs{Output::servo_flow, Output::leakage_flow, Output::command};
enum FlowColumn { kServo, kLeak, kCommand };

/// Maximum number of intervals per period; more would not help.
constexpr int kMostIntervals = 16384;
/// A mean flow below this fraction counts as zero, because relative changes would be meaningless.
constexpr double kNoFlow = 1e-9;
/// The command counts as saturated above this fraction of its limit.
constexpr double kAtLimit = 0.999;
/// Largest y (see the header) that the two changes can determine reliably. Close to 1, simulation
/// noise can produce any quotient.
constexpr double kSlowest = 0.8;
/// After kTellingPeriods, a loop in self-sustained oscillation can be recognised: its transient has
/// not decreased to the fraction kDecays since the run with half as many periods, as it would have
/// to if it were to decay within the maximum number of periods. In addition, the remaining
/// transient must exceed kNotNoise tolerances, to be distinguishable from simulation noise.
constexpr int kTellingPeriods = 256;
constexpr double kDecays = 0.7;
constexpr double kNotNoise = 10.0;

model::SimulationInputs inputs(const datasets::LeakSignal& signal) {
  model::SimulationInputs in;
  in.drive = datasets::periodic_signal(signal.waveform, signal.amplitude, signal.frequency_hz);
  return in;
}

model::Rig from_rest(model::Rig rig) {
  rig.initial = model::InitialState::rest;
  rig.before = model::Before::hold;
  return rig;
}

std::string why(const model::Simulation& run) {
  return fmt::format("{} at {:.6g} s: {}", to_string(run.status), run.failed_at_s, run.reason);
}

/// Sampling stride in the two earlier periods.
constexpr std::size_t kEarlyStride = 4;

/// A run with three sampled periods. Periods n/4 and n/2 are sampled coarsely, to observe the
/// transient, and the last one finely.
struct Run {
  PeriodGrid grid;        ///< grid of the last period
  PeriodGrid early_grid;  ///< grid of the two earlier periods
  model::Simulation simulation;

  std::span<const double> last(const Eigen::MatrixXd& matrix, Eigen::Index column) const {
    const std::size_t n = grid.offset_s.size();
    return {matrix.col(column).data() + static_cast<std::size_t>(matrix.rows()) - n, n};
  }
  double mean(FlowColumn column, std::size_t stride = 1) const {
    return mean_absolute(grid, last(simulation.outputs, column), stride);
  }
  /// Returns the mean in period n/4 (0) or n/2 (1).
  double early_mean(FlowColumn column, std::size_t which) const {
    const std::size_t n = early_grid.offset_s.size();
    const double* first = simulation.outputs.col(column).data() +
                          static_cast<std::size_t>(simulation.outputs.rows()) -
                          grid.offset_s.size() - (2 - which) * n;
    return mean_absolute(early_grid, {first, n});
  }
};

Run make_run(const PeriodicDrive& drive, const model::ParameterValues& values,
             std::span<const int> free, int periods, int intervals,
             const model::SimulationOptions& options) {
  const double period_s = 1.0 / drive.signal.frequency_hz;
  Run run;
  run.grid = period_grid(drive.signal.waveform, period_s, intervals);
  run.early_grid =
      period_grid(drive.signal.waveform, period_s, intervals / static_cast<int>(kEarlyStride));
  std::vector<double> times;
  if (periods > 4) times.push_back(0.0);  // a simulation starts from rest at its first time
  const auto add = [&](const PeriodGrid& grid, int period) {
    for (const double offset : grid.offset_s) times.push_back((period - 1) * period_s + offset);
  };
  add(run.early_grid, periods / 4);
  add(run.early_grid, periods / 2);
  add(run.grid, periods);
  run.simulation = model::simulate(from_rest(drive.rig), values, free, inputs(drive.signal), times,
                                   kOutputs, options);
  return run;
}

/// Returns the larger of the relative sampling errors of the two mean flows. Each is estimated by
/// Richardson extrapolation for a second-order rule: a third of the change when every second sample
/// is left out.
double sampling_error(const Run& run) {
  const double servo = run.mean(kServo);
  double worst = 0.0;
  for (const FlowColumn column : {kServo, kLeak}) {
    const double fine = run.mean(column);
    const double coarse = run.mean(column, 2);
    worst = std::max(worst, std::abs(fine - coarse) / (3.0 * std::max(fine, kNoFlow * servo)));
  }
  return worst;
}

/// Returns the remaining transient of one flow, relative to the flow (see the header). `noise` is
/// the difference that the simulation tolerance causes between two otherwise identical periods.
double transient_left(const Run& run, FlowColumn column, double noise) {
  const double last = run.mean(column, kEarlyStride);
  const double scale = std::max(last, kNoFlow * run.mean(kServo, kEarlyStride));
  const double early = std::abs(run.early_mean(column, 1) - run.early_mean(column, 0)) / scale;
  const double late = std::abs(last - run.early_mean(column, 1)) / scale;
  if (late <= noise && early <= noise) return 0.0;
  const double quotient = early > 0.0 ? late / early : HUGE_VAL;
  const double y = std::min(kSlowest, 0.5 * (std::sqrt(1.0 + 4.0 * quotient) - 1.0));
  // A fast component of the transient may hide a slow one, so the result is at least the last
  // change.
  return late * std::max(1.0, y * y / (1.0 - y * y));
}

double saturated_part(const Run& run, const model::ParameterValues& values) {
  if (!values.is_given("output_limit")) return 0.0;
  const double limit = kAtLimit * values["output_limit"];
  const auto command = run.last(run.simulation.outputs, kCommand);
  const auto& offset = run.grid.offset_s;
  double at_limit = 0.0;
  for (std::size_t i = 1; i < offset.size(); ++i) {
    if (std::abs(command[i]) >= limit && std::abs(command[i - 1]) >= limit) {
      at_limit += offset[i] - offset[i - 1];
    }
  }
  return at_limit / offset.back();
}

Eigen::VectorXd slopes(const Run& run, FlowColumn column) {
  const auto& matrix = run.simulation.sensitivities[column];
  const auto y = run.last(run.simulation.outputs, column);
  Eigen::VectorXd result(matrix.cols());
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    result(j) = mean_absolute_slope(run.grid, y, run.last(matrix, j));
  }
  return result;
}

/// Returns the last rows. Avoids taking a block of a matrix without columns, which would add an
/// offset to a null pointer.
Eigen::MatrixXd last_rows(const Eigen::MatrixXd& matrix, Eigen::Index rows) {
  if (matrix.cols() == 0) return {rows, 0};
  return matrix.bottomRows(rows);
}

}  // namespace

PeriodicFlow periodic_flow(const PeriodicDrive& drive, const model::ParameterValues& values,
                           std::span<const int> free, const PeriodicOptions& options) {
  if (options.periods < 4 || options.periods % 4 != 0) {
    throw std::invalid_argument("periodic_flow: periods must be a multiple of 4");
  }
  PeriodicFlow flow;
  flow.periods = options.periods;
  flow.intervals = options.intervals;
  const double noise = 0.2 * options.tolerance;
  double left_before = HUGE_VAL;
  while (true) {
    const Run run = make_run(drive, values, free, flow.periods, flow.intervals, options.simulation);
    if (!run.simulation.ok()) {
      flow.failure = why(run.simulation);
      return flow;
    }
    flow.servo_flow_m3_per_s = run.mean(kServo);
    flow.leak_flow_m3_per_s = run.mean(kLeak);
    if (!(flow.servo_flow_m3_per_s > 0.0)) {
      flow.failure = "there is no servo flow, so no share of it leaks";
      return flow;
    }
    const double sampling = sampling_error(run);
    if (sampling > options.tolerance && 2 * flow.intervals <= kMostIntervals) {
      flow.intervals *= 2;
      continue;
    }
    const double left =
        std::max(transient_left(run, kServo, noise), transient_left(run, kLeak, noise));
    const bool decays = flow.periods < kTellingPeriods || left < kDecays * left_before ||
                        left < kNotNoise * options.tolerance;
    if (left > options.tolerance && decays && 2 * flow.periods <= options.most_periods) {
      left_before = left;
      flow.periods *= 2;
      continue;
    }
    if (sampling > options.tolerance) {
      flow.failure =
          fmt::format("with {} samples per half period, {:.2g} of the mean flow is uncertain",
                      flow.intervals, sampling);
    }
    if (left > options.tolerance) {
      flow.failure = fmt::format(
          "not periodic after {} periods: the mean flows still change by a fraction of {:.2g}",
          flow.periods, left);
    }
    flow.saturated = saturated_part(run, values);
    if (!free.empty()) {
      flow.servo_slope = slopes(run, kServo);
      flow.leak_slope = slopes(run, kLeak);
    }
    return flow;
  }
}

PeriodicSeries periodic_series(const PeriodicDrive& drive, const model::ParameterValues& values,
                               std::span<const int> free, std::span<const Output> outputs,
                               int periods, int samples, const model::SimulationOptions& options) {
  const double period_s = 1.0 / drive.signal.frequency_hz;
  PeriodicSeries series;
  std::vector<double> times{0.0};
  for (int i = 0; i < samples; ++i) {
    series.time_s.push_back(i * period_s / samples);
    times.push_back((periods - 1) * period_s + series.time_s.back());
  }
  if (periods == 1) times.erase(times.begin());
  series.run = model::simulate(from_rest(drive.rig), values, free, inputs(drive.signal), times,
                               outputs, options);
  if (series.run.ok()) {
    series.run.outputs = last_rows(series.run.outputs, samples);
    for (auto& slope : series.run.sensitivities) slope = last_rows(slope, samples);
  }
  return series;
}

}  // namespace rigcal::diagnosis
