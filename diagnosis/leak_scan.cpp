#include "diagnosis/leak_scan.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <vector>

#include "diagnosis/steady_leak.hpp"
#include "metrics/leak_share.hpp"

namespace rigcal::diagnosis {
namespace {

/// Steps of the range: a fit finds its way from the nearest.
constexpr double kRatio = 1.35;
constexpr double kFirst = 1e-3;
constexpr double kLargest = 1e3;

/// One coefficient, in the record itself.
struct Candidate {
  double coefficient = 0.0;
  double share = 0.0;
  double cost = 0.0;  ///< half the sum of squared weighted residuals
};

std::vector<double> steady_column(const model::Simulation& run, Eigen::Index column,
                                  const SteadyPart& part) {
  const auto values = run.outputs.col(column).segment(static_cast<Eigen::Index>(part.first),
                                                      static_cast<Eigen::Index>(part.count));
  return {values.begin(), values.end()};
}

Candidate simulate_leak(const calib::Problem& problem, const calib::ProblemCondition& condition,
                        double coefficient) {
  const SteadyPart part = steady_part(condition);
  if (part.count < 2) {
    throw NoResultError(
        fmt::format("condition \"{}\": one sample counts, and a share is of flows over a time; "
                    "expected at least 2",
                    condition.condition->id));
  }
  model::ParameterValues values = condition.values;
  values.set("leakage_coefficient", coefficient);
  std::vector<model::Output> outputs = condition.outputs;
  outputs.push_back(model::Output::servo_flow);
  outputs.push_back(model::Output::leakage_flow);
  model::SimulationOptions options;
  options.method = problem.campaign->simulation.method;
  options.tolerance = problem.tolerance;
  options.max_seconds = problem.campaign->simulation.max_seconds;
  const auto& time_s = condition.record->time_s;
  const auto run =
      model::simulate(condition.rig, values, {}, condition.inputs, time_s, outputs, options);
  if (!run.ok()) {
    throw NoResultError(fmt::format(
        "condition \"{}\" could not be simulated with a leakage coefficient of {:g}: {} at {:g} s",
        condition.condition->id, coefficient, run.reason, run.failed_at_s));
  }
  Candidate point;
  point.coefficient = coefficient;
  for (std::size_t k = 0; k < condition.channels.size(); ++k) {
    const calib::ProblemChannel& channel = condition.channels[k];
    for (std::size_t i = 0; i < condition.rows.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(condition.rows[i]);
      const double error =
          (run.outputs(row, static_cast<Eigen::Index>(k)) - channel.measured[i]) / channel.sd;
      point.cost += 0.5 * error * error;
    }
  }
  const auto columns = static_cast<Eigen::Index>(outputs.size());
  const auto servo = steady_column(run, columns - 2, part);
  const auto leak = steady_column(run, columns - 1, part);
  const auto times = std::span(time_s).subspan(part.first, part.count);
  try {
    point.share = metrics::leak_share(times, servo, leak);
  } catch (const std::domain_error&) {
    throw NoResultError(
        fmt::format("condition \"{}\": the simulated run moves no oil, so no share "
                    "of it can leak",
                    condition.condition->id));
  }
  return point;
}

}  // namespace

LeakScan scan_leaks(const calib::Problem& problem, const calib::ProblemCondition& condition,
                    double share_above) {
  Candidate best = simulate_leak(problem, condition, 0.0);
  // The coefficient says nothing without its area: the range begins where a thousandth leaks.
  double coefficient = kFirst;
  Candidate point = simulate_leak(problem, condition, coefficient);
  while (point.share > 1e-3 && coefficient > 1e-12)
    point = simulate_leak(problem, condition, coefficient *= 0.1);
  while (point.share < 2e-4 && coefficient < kLargest)
    point = simulate_leak(problem, condition, coefficient *= 5.0);
  while (true) {
    const bool is_better = point.cost < best.cost;
    if (is_better) best = point;
    if ((point.share >= share_above && !is_better) || coefficient >= kLargest) break;
    // Coarser steps where the share is small and all but proportional to the coefficient.
    coefficient *= point.share < 0.02 ? 2.0 : kRatio;
    point = simulate_leak(problem, condition, coefficient);
  }
  return {best.coefficient, coefficient};
}

}  // namespace rigcal::diagnosis
