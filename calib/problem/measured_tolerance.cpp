#include "calib/problem/measured_tolerance.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "calib/problem/evaluation.hpp"
#include "common/parallel.hpp"

namespace rigcal::calib {
namespace {

/// Tolerances of the two simulations that are compared. Errors are roughly proportional to the
/// tolerance, so the difference is approximately the error of the coarser simulation.
constexpr double kCoarserRun = 1e-5;
constexpr double kFinerRun = 1e-6;
/// Norm of the errors of all residuals, each divided by its standard deviation. In the worst case
/// an estimate moves by this many standard errors; errors that change sign move it less.
constexpr double kHarmless = 0.005;
/// A tolerance is changed only if it is too coarse by more than this factor.
constexpr double kMuchFiner = 2.0;
/// Largest tolerance that these two runs can establish. Beyond it errors no longer grow with the
/// tolerance, because steps end at each sample.
constexpr double kLargestMeasured = 1e-2;

/// Returns the RMS error of a residual, in standard deviations, at which the errors of all
/// residuals together are harmless.
double harmless_error(const Problem& problem) {
  return kHarmless / std::sqrt(static_cast<double>(problem.residual_count()));
}

/// Returns the root mean square difference between the two simulations, in standard deviations; NaN
/// if either fails.
double simulation_error(const Problem& problem, std::size_t i, std::span<const double> z,
                        const std::atomic<bool>* cancel) {
  const ProblemCondition& data = problem.conditions[i];
  const auto run = [&](double tolerance) {
    return model::simulate(data.rig, problem.values_at(i, z), std::vector<int>(), data.inputs,
                           data.fit_times(), data.outputs,
                           simulation_options(problem, i, tolerance, cancel));
  };
  const model::Simulation coarser = run(kCoarserRun);
  if (!coarser.ok()) return std::nan("");
  const model::Simulation finer = run(kFinerRun);
  if (!finer.ok()) return std::nan("");
  double squares = 0.0;
  for (std::size_t k = 0; k < data.channels.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    for (const std::size_t row : data.rows) {
      const auto sample = static_cast<Eigen::Index>(row);
      const double error = coarser.outputs(sample, column) - finer.outputs(sample, column);
      squares += error * error / (data.channels[k].sd * data.channels[k].sd);
    }
  }
  return std::sqrt(squares / static_cast<double>(data.rows.size() * data.channels.size()));
}

/// Returns true if the rig is driven by the samples of the record.
bool has_recorded_drive(const ProblemCondition& condition) {
  return condition.condition->waveform == datasets::Waveform::recorded &&
         !condition.record->generated_drive;
}

/// Returns the measured tolerance of each condition, or 0 if none was measured.
std::vector<double> measure_all(const Problem& problem, std::span<const double> z, int threads,
                                const std::atomic<bool>* cancel) {
  const double harmless = harmless_error(problem);
  std::vector<double> result(problem.conditions.size(), 0.0);
  const auto& unknowns = problem.map.unknowns();
  const bool nuisance_alone =
      !unknowns.empty() &&
      std::all_of(unknowns.begin(), unknowns.end(), [](const auto& each) { return each.nuisance; });
  if (problem.tolerance_fixed || nuisance_alone) return result;
  parallel_for(result.size(), threads, [&](std::size_t i) {
    if (!has_recorded_drive(problem.conditions[i])) return;
    const double error = simulation_error(problem, i, z, cancel);
    if (std::isnan(error)) return;
    result[i] =
        std::min(kLargestMeasured, error > 0.0 ? kCoarserRun * harmless / error : kLargestMeasured);
  });
  return result;
}

}  // namespace

void measure_tolerances(Problem& problem, std::span<const double> z, int threads,
                        const std::atomic<bool>* cancel) {
  const std::vector<double> found = measure_all(problem, z, threads, cancel);
  for (std::size_t i = 0; i < found.size(); ++i)
    problem.conditions[i].measured_tolerance = found[i];
}

bool refine_tolerances(Problem& problem, std::span<const double> z, int threads,
                       const std::atomic<bool>* cancel) {
  const std::vector<double> found = measure_all(problem, z, threads, cancel);
  bool changed = false;
  for (std::size_t i = 0; i < found.size(); ++i) {
    double& own = problem.conditions[i].measured_tolerance;
    const double least = std::max(found[i], problem.tolerance);
    if (!(found[i] > 0.0) || !(own > kMuchFiner * least)) continue;
    const double before = problem.tolerance_of(i);
    own = least;
    changed = changed || problem.tolerance_of(i) < before;
  }
  return changed;
}

double largest_simulation_error(const Problem& problem) {
  const double harmless = harmless_error(problem);
  double squares = 0.0;
  for (std::size_t i = 0; i < problem.conditions.size(); ++i) {
    const ProblemCondition& condition = problem.conditions[i];
    const double tolerance = problem.tolerance_of(i);
    for (const ProblemChannel& channel : condition.channels) {
      const double error = condition.measured_tolerance > 0.0
                               ? kMuchFiner * harmless * tolerance / condition.measured_tolerance
                               : tolerance * channel.peak_to_peak / channel.sd;
      squares += static_cast<double>(condition.rows.size()) * error * error;
    }
  }
  return std::sqrt(squares);
}

}  // namespace rigcal::calib
