#include "diagnosis/record/leak_scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "diagnosis/record/record_share.hpp"

namespace rigcal::diagnosis {
namespace {

/// Ratio of successive coefficients, small enough for a fit to converge from the nearest one.
constexpr double kRatio = 1.35;
/// Range of the coefficients, in units of the law (unit_of()).
constexpr double kFirst = 1e-3;
constexpr double kLeast = 1e-12;
constexpr double kLargest = 1e3;

/// Returns the coefficient of a large leak, to which the range of a scan refers. At 1 MPa, an
/// orifice of 1 mm2 with a coefficient of 1 leaks about half as much as a laminar leak of
/// 1e-10 m3/(s Pa).
double unit_of(datasets::LeakLaw law) { return law == datasets::LeakLaw::laminar ? 1e-10 : 1.0; }

/// A simulated coefficient and its comparison with the record.
struct Candidate {
  double coefficient = 0.0;
  double share = 0.0;
  double cost = 0.0;  ///< half the sum of squared weighted residuals
};

Candidate simulate_leak(const calib::Problem& problem, const calib::ProblemCondition& condition,
                        double coefficient, const std::atomic<bool>* cancel) {
  model::ParameterValues values = condition.values;
  const char* const leak = datasets::leak_parameter(problem.campaign->diagnosis.leak_law);
  values.set(leak, coefficient);
  std::vector<model::Output> outputs = condition.outputs;
  outputs.push_back(model::Output::servo_flow);
  outputs.push_back(model::Output::leakage_flow);
  // As coarse as the search, which starts from the best coefficient.
  model::SimulationOptions options = problem.simulation_options(cancel);
  options.tolerance = problem.coarse_tolerance();
  const auto run = model::simulate(condition.rig, values, {}, condition.inputs,
                                   condition.record->time_s, outputs, options);
  if (!run.ok()) {
    throw NoResultError(
        fmt::format("condition \"{}\" could not be simulated with {} = {:g}: {} at {:g} s",
                    condition.condition->id, leak, coefficient, run.reason, run.failed_at_s));
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
  const auto servo = static_cast<Eigen::Index>(condition.channels.size());
  point.share = leak_in_record(condition, run, servo).share;
  return point;
}

}  // namespace

LeakScan scan_leaks(const calib::Problem& problem, const calib::ProblemCondition& condition,
                    double share_above, const std::atomic<bool>* cancel) {
  const datasets::LeakLaw law = problem.campaign->diagnosis.leak_law;
  if (law == datasets::LeakLaw::orifice && !(condition.values["leakage_area"] > 0.0)) {
    throw NoResultError(fmt::format(
        "condition \"{}\": leakage_area is 0 m2, and a leak is the coefficient times this area, so "
        "no leakage coefficient can be estimated; expected the area of an orifice, such as --set "
        "leakage_area=\"1 mm2\", or leak_law = \"laminar\" in [diagnosis]",
        condition.condition->id));
  }
  const auto at = [&](double coefficient) {
    return simulate_leak(problem, condition, coefficient, cancel);
  };
  Candidate best = at(0.0);
  // The flow of a coefficient depends on the rig, so the range begins where a
  // thousandth of the flow leaks.
  const double unit = unit_of(law);
  double coefficient = kFirst * unit;
  Candidate point = at(coefficient);
  while (point.share > 1e-3 && coefficient > kLeast * unit) point = at(coefficient *= 0.1);
  while (point.share < 2e-4 && coefficient < kLargest * unit)
    point = at(coefficient = std::min(kLargest * unit, 5.0 * coefficient));
  while (true) {
    const bool is_better = point.cost < best.cost;
    if (is_better) best = point;
    if ((point.share >= share_above && !is_better) || coefficient >= kLargest * unit) break;
    // Larger steps are possible while the share is small and almost proportional to the
    // coefficient.
    coefficient = std::min(kLargest * unit, coefficient * (point.share < 0.02 ? 2.0 : kRatio));
    point = at(coefficient);
  }
  return {best.coefficient, coefficient};
}

}  // namespace rigcal::diagnosis
