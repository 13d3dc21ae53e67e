#include "diagnosis/leak_trend.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "common/calendar.hpp"
#include "metrics/distributions.hpp"

namespace rigcal::diagnosis {
namespace {

/// A trend, or scatter about it, of less probability is significant.
constexpr double kSignificantTrend = 0.05;

/// A state with the day of its date.
struct DatedState {
  const MachineState* state = nullptr;
  int day = 0;
};

struct DatedMachine {
  std::string leak_level, specimen;
  std::vector<DatedState> states;
};

/// A straight line through coefficients.
struct TrendLine {
  double slope = 0.0;
  double standard_error = 0.0;
  double freedom = 1.0;  ///< with which that error is known
  double chi_squared = 0.0;
  double widened = 1.0;
};

std::vector<DatedMachine> dated_machines(const std::vector<MachineState>& states) {
  std::vector<DatedMachine> machines;
  for (const MachineState& state : states) {
    const auto day = day_of(state.key.date);
    if (!state.ok() || !day) continue;
    auto machine = std::find_if(machines.begin(), machines.end(), [&](const DatedMachine& each) {
      return each.leak_level == state.key.leak_level && each.specimen == state.key.specimen;
    });
    if (machine == machines.end())
      machine = machines.insert(machines.end(), {state.key.leak_level, state.key.specimen, {}});
    machine->states.push_back({&state, *day});
  }
  std::erase_if(machines, [](const DatedMachine& each) { return each.states.size() < 2; });
  for (DatedMachine& each : machines) {
    std::sort(each.states.begin(), each.states.end(),
              [](const DatedState& a, const DatedState& b) { return a.day < b.day; });
  }
  return machines;
}

TrendLine line_through(const std::vector<DatedState>& states,
                       const Eigen::MatrixXd& rig_covariance) {
  const auto n = static_cast<Eigen::Index>(states.size());
  Eigen::MatrixXd design = Eigen::MatrixXd::Ones(n, 2);
  Eigen::VectorXd coefficients(n);
  Eigen::VectorXd own(n);
  Eigen::MatrixXd moves(n, rig_covariance.rows());
  for (Eigen::Index i = 0; i < n; ++i) {
    const DatedState& each = states[static_cast<std::size_t>(i)];
    const PooledLeak& pooled = each.state->pooled;
    design(i, 1) = each.day - states.front().day;
    coefficients(i) = pooled.coefficient;
    own(i) = pooled.error.own_se * pooled.error.own_se;
    if (moves.cols() > 0) moves.row(i) = pooled.rig_moves.transpose();
  }
  Eigen::MatrixXd covariance = moves * rig_covariance * moves.transpose();
  covariance.diagonal() += own;
  const Eigen::LLT<Eigen::MatrixXd> root(covariance);
  const Eigen::MatrixXd weighted = root.solve(design);
  const Eigen::Matrix2d errors = (design.transpose() * weighted).inverse();
  const Eigen::MatrixXd weights =
      errors * weighted.transpose();  // of the coefficients, shape (2, n)
  const Eigen::Vector2d line = weights * coefficients;

  TrendLine result;
  result.slope = line(1);
  const Eigen::VectorXd off = coefficients - design * line;
  result.chi_squared = off.dot(root.solve(off));
  const auto scatter_freedom = static_cast<double>(n - 2);
  if (n > 2 &&
      metrics::chi_squared_exceedance(result.chi_squared, scatter_freedom) < kSignificantTrend)
    result.widened = std::max(1.0, std::sqrt(result.chi_squared / scatter_freedom));
  result.standard_error = result.widened * std::sqrt(errors(1, 1));
  double squares = 0.0;  // of Welch and Satterthwaite
  for (Eigen::Index i = 0; i < n; ++i) {
    const double part = weights(1, i) * weights(1, i) * own(i);
    squares += part * part / states[static_cast<std::size_t>(i)].state->pooled.error.freedom;
  }
  result.freedom = std::clamp(errors(1, 1) * errors(1, 1) / squares, 1.0, 1e6);
  return result;
}

/// When the line reaches the next limit.
void foresee(const MachineState& last, const datasets::DiagnosisSettings& settings,
             LeakTrend& trend) {
  const double share = last.estimate.share;
  const auto next = std::upper_bound(settings.limits.begin(), settings.limits.end(), share);
  if (next == settings.limits.end()) return;
  const auto day = [&](double per_day) { return trend.last_day + (*next - share) / per_day; };
  trend.next_class =
      datasets::kLeakClasses[static_cast<std::size_t>(next - settings.limits.begin()) + 1];
  trend.next_limit = *next;
  trend.reached_day = day(trend.share_per_day);
  trend.earliest_day = day(trend.share_per_day_ci95.second);
  if (trend.share_per_day_ci95.first > 0.0) trend.latest_day = day(trend.share_per_day_ci95.first);
}

LeakTrend trend_of(const DatedMachine& machine, const Eigen::MatrixXd& rig_covariance,
                   const datasets::DiagnosisSettings& settings) {
  const TrendLine line = line_through(machine.states, rig_covariance);
  const MachineState& last = *machine.states.back().state;
  LeakTrend trend;
  trend.leak_level = machine.leak_level;
  trend.specimen = machine.specimen;
  trend.duty = last.duty;
  trend.first_day = machine.states.front().day;
  trend.last_day = machine.states.back().day;
  trend.dates = static_cast<int>(machine.states.size());
  trend.coefficient_per_day = line.slope;
  trend.share_per_day = last.share_slope * line.slope;
  const double half =
      last.share_slope * line.standard_error * metrics::student_t_quantile(0.975, line.freedom);
  trend.share_per_day_ci95 = {trend.share_per_day - half, trend.share_per_day + half};
  trend.p = 2.0 * metrics::student_t_cdf(-std::abs(line.slope) / line.standard_error, line.freedom);
  trend.significant = trend.p < kSignificantTrend;
  trend.chi_squared = line.chi_squared;
  trend.freedom = static_cast<double>(machine.states.size() - 2);
  trend.widened = line.widened;
  if (trend.significant && line.slope > 0.0) foresee(last, settings, trend);
  return trend;
}

}  // namespace

std::vector<LeakTrend> leak_trends(const std::vector<MachineState>& states,
                                   const Eigen::MatrixXd& rig_covariance,
                                   const datasets::DiagnosisSettings& settings) {
  std::vector<LeakTrend> trends;
  for (const DatedMachine& machine : dated_machines(states))
    trends.push_back(trend_of(machine, rig_covariance, settings));
  return trends;
}

}  // namespace rigcal::diagnosis
