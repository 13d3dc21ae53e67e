#include "diagnosis/leak_curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "metrics/leak_share.hpp"

namespace rigcal::diagnosis {
namespace {

/// Steps of the range: fine enough for the plateau of a ringing square wave.
constexpr double kRatio = 1.35;
constexpr double kFirst = 1e-3;
constexpr double kLargest = 1e3;

std::vector<double> steady_column(const model::Simulation& run, Eigen::Index column,
                                  const SteadyPart& part) {
  const auto values = run.outputs.col(column).segment(static_cast<Eigen::Index>(part.first),
                                                      static_cast<Eigen::Index>(part.count));
  return {values.begin(), values.end()};
}

/// Slopes of a cubic interpolation that is monotone wherever the points are. F. N. Fritsch and
/// J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984).
std::vector<double> monotone_slopes(const std::vector<LeakPoint>& points,
                                    double LeakPoint::*member) {
  const std::size_t n = points.size();
  std::vector<double> width(n - 1);
  std::vector<double> secant(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    width[i] = points[i + 1].coefficient - points[i].coefficient;
    secant[i] = (points[i + 1].*member - points[i].*member) / width[i];
  }
  std::vector<double> slopes(n, 0.0);
  slopes.front() = secant.front();
  slopes.back() = secant.back();
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (secant[i - 1] * secant[i] <= 0.0) continue;
    const double a = 2.0 * width[i] + width[i - 1];
    const double b = width[i] + 2.0 * width[i - 1];
    slopes[i] = (a + b) / (a / secant[i - 1] + b / secant[i]);
  }
  return slopes;
}

}  // namespace

SteadyPart steady_part(const calib::ProblemCondition& condition) {
  const std::vector<double>& time_s = condition.record->time_s;
  const std::size_t begin = condition.rows.front();
  const std::size_t end = condition.rows.back() + 1;
  const datasets::Condition& c = *condition.condition;
  const bool periodic =
      c.waveform == datasets::Waveform::sine || c.waveform == datasets::Waveform::square;
  if (!periodic || !c.frequency_hz) return {begin, end - begin};
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

LeakPoint simulate_leak(const calib::Problem& problem, const calib::ProblemCondition& condition,
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
  LeakPoint point;
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
  point.leak_flow_m3_per_s = metrics::mean_absolute(times, leak);
  return point;
}

LeakCurve::LeakCurve(std::vector<LeakPoint> points) : points_(std::move(points)) {
  bool increasing = points_.size() >= 4;
  for (std::size_t i = 1; i < points_.size(); ++i)
    increasing = increasing && points_[i].coefficient > points_[i - 1].coefficient;
  if (!increasing)
    throw std::invalid_argument("LeakCurve: expected at least 4 points of increasing coefficient");
  share_slopes_ = monotone_slopes(points_, &LeakPoint::share);
  flow_slopes_ = monotone_slopes(points_, &LeakPoint::leak_flow_m3_per_s);
}

double LeakCurve::interpolate(double LeakPoint::*member, const std::vector<double>& slopes,
                              double coefficient) const {
  if (!(coefficient > 0.0)) return 0.0;
  const LeakPoint& last = points_.back();
  if (coefficient >= last.coefficient)
    return last.*member + slopes.back() * (coefficient - last.coefficient);
  const auto above = std::upper_bound(
      points_.begin(), points_.end(), coefficient,
      [](double value, const LeakPoint& point) { return value < point.coefficient; });
  const auto i = static_cast<std::size_t>(above - points_.begin()) - 1;
  const double width = points_[i + 1].coefficient - points_[i].coefficient;
  const double t = (coefficient - points_[i].coefficient) / width;
  const double s = 1.0 - t;
  return s * s * (1.0 + 2.0 * t) * (points_[i].*member) +
         t * t * (3.0 - 2.0 * t) * (points_[i + 1].*member) +
         width * t * s * (s * slopes[i] - t * slopes[i + 1]);
}

double LeakCurve::share(double coefficient) const {
  return interpolate(&LeakPoint::share, share_slopes_, coefficient);
}

double LeakCurve::leak_flow_m3_per_s(double coefficient) const {
  return interpolate(&LeakPoint::leak_flow_m3_per_s, flow_slopes_, coefficient);
}

double LeakCurve::best_coefficient() const {
  return std::min_element(points_.begin(), points_.end(),
                          [](const LeakPoint& a, const LeakPoint& b) { return a.cost < b.cost; })
      ->coefficient;
}

LeakCurve leak_curve(const calib::Problem& problem, const calib::ProblemCondition& condition,
                     double share_above) {
  std::vector<LeakPoint> points{simulate_leak(problem, condition, 0.0)};
  // The coefficient says nothing without its area: the range begins where a thousandth leaks.
  double coefficient = kFirst;
  LeakPoint point = simulate_leak(problem, condition, coefficient);
  while (point.share > 1e-3 && coefficient > 1e-12)
    point = simulate_leak(problem, condition, coefficient *= 0.1);
  while (point.share < 2e-4 && coefficient < kLargest)
    point = simulate_leak(problem, condition, coefficient *= 5.0);
  points.push_back(point);
  // Coarser steps where the share is small and all but proportional to the coefficient.
  while (points.size() < 4 || (point.share < share_above && coefficient < kLargest)) {
    coefficient *= point.share < 0.02 ? 2.0 : kRatio;
    point = simulate_leak(problem, condition, coefficient);
    points.push_back(point);
  }
  return LeakCurve(std::move(points));
}

}  // namespace rigcal::diagnosis
