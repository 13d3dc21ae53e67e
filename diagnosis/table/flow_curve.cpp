#include "diagnosis/table/flow_curve.hpp"

#include <fmt/format.h>

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>

#include "common/error.hpp"

namespace rigcal::diagnosis {
namespace {

/// Tolerance for a root in ln coefficient. It is well below the resolution of three printed digits,
/// and above the noise of the flows.
constexpr double kRootWidth = 1e-4;
/// Maximum number of steps for a root. Even bisection from two decades down to the tolerance would
/// need only sixteen.
constexpr std::uintmax_t kMostRootSteps = 60;
/// An interval of the scan is flat if the quantity grows with less than the power kFlatPower of the
/// coefficient. It is close to a target if the quantity is within the factor kNear of it.
constexpr double kFlatPower = 0.5;
constexpr double kNear = 1.25;
/// A flat interval is divided down to this width in ln coefficient, a fiftieth of a decade.
constexpr double kFinest = 0.046;

}  // namespace

PeriodicFlow FlowCurve::simulate(double coefficient, std::span<const int> free) const {
  model::ParameterValues values = values_;
  values.set("leakage_coefficient", coefficient);
  PeriodicOptions options = options_;
  if (const PeriodicFlow* neighbour = nearest(coefficient)) {
    options.periods = neighbour->periods;
    options.intervals = neighbour->intervals;
  }
  PeriodicFlow flow = periodic_flow(drive_, values, free, options);
  if (!flow.ok()) {
    throw NoResultError(fmt::format("{} at leakage_coefficient = {:.6g}: {}", drive_.signal.name(),
                                    coefficient, flow.failure));
  }
  return flow;
}

const PeriodicFlow* FlowCurve::nearest(double coefficient) const {
  if (known_.empty()) return nullptr;
  const auto above = known_.lower_bound(coefficient);
  if (above == known_.begin()) return &above->second;
  const auto below = std::prev(above);
  const bool take_above =
      above != known_.end() && above->first / coefficient < coefficient / below->first;
  return take_above ? &above->second : &below->second;
}

const PeriodicFlow& FlowCurve::at(double coefficient) {
  const auto found = known_.find(coefficient);
  if (found != known_.end()) return found->second;
  return known_.emplace(coefficient, simulate(coefficient, {})).first->second;
}

double FlowCurve::log_slope(double coefficient) const {
  return coefficient * share_slopes(coefficient, {})(0);
}

Eigen::VectorXd FlowCurve::share_slopes(double coefficient, std::span<const int> parameters) const {
  std::vector<int> free{model::parameter_index(values_.plant, "leakage_coefficient")};
  free.insert(free.end(), parameters.begin(), parameters.end());
  const PeriodicFlow flow = simulate(coefficient, free);
  return flow.leak_slope / flow.leak_flow_m3_per_s - flow.servo_slope / flow.servo_flow_m3_per_s;
}

void FlowCurve::scan(double lowest, double highest, int per_decade) {
  const double decades = std::log10(highest / lowest);
  const int intervals = std::max(1, static_cast<int>(std::ceil(decades * per_decade)));
  for (int i = 0; i <= intervals; ++i) {
    at(lowest * std::pow(highest / lowest, static_cast<double>(i) / intervals));
  }
}

void FlowCurve::polish(const Quantity& quantity, double target) {
  for (auto left = known_.begin(); left != known_.end();) {
    const auto right = std::next(left);
    if (right == known_.end()) return;
    const double low = quantity(left->second);
    const double high = quantity(right->second);
    const double width = std::log(right->first / left->first);
    const bool near = std::min(low, high) < kNear * target && target < kNear * std::max(low, high);
    const bool flat = std::abs(std::log(high / low)) < kFlatPower * width;
    if (near && flat && width > kFinest) {
      at(std::sqrt(left->first * right->first));  // the left half is then checked again
    } else {
      left = right;
    }
  }
}

std::vector<double> FlowCurve::roots(const Quantity& quantity, double target) {
  polish(quantity, target);
  const auto distance = [&](double log_coefficient) {
    return std::log(quantity(at(std::exp(log_coefficient))) / target);
  };
  const auto narrow = [](double a, double b) { return std::abs(a - b) <= kRootWidth; };
  std::vector<std::pair<double, double>> points;  // pairs of ln coefficient and distance
  for (const auto& [coefficient, flow] : known_) {
    points.emplace_back(std::log(coefficient), std::log(quantity(flow) / target));
  }
  std::vector<double> found;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const auto [a, fa] = points[i];
    const auto [b, fb] = points[i + 1];
    if (fa == 0.0) found.push_back(std::exp(a));
    if (!(fa * fb < 0.0)) continue;
    std::uintmax_t steps = kMostRootSteps;
    const auto bracket = boost::math::tools::toms748_solve(distance, a, b, fa, fb, narrow, steps);
    found.push_back(std::exp(0.5 * (bracket.first + bracket.second)));
  }
  if (!points.empty() && points.back().second == 0.0)
    found.push_back(std::exp(points.back().first));
  return found;
}

}  // namespace rigcal::diagnosis
