#include "diagnosis/record/leak_memo.hpp"

#include <cmath>

#include "common/error.hpp"

namespace rigcal::diagnosis {
namespace {

/// Ratio of the coefficients of two nodes. The shares of the demo's squares of 10 Hz change their
/// slope by a third within a tenth of the coefficient. With this ratio all shares of the demo are
/// within the tolerance of a mean flow; with 1.1 one is off by thirteen times that.
constexpr double kNodeRatio = 1.03;

double node(double power) { return std::pow(kNodeRatio, power); }

/// Returns the power of the last node that does not exceed a coefficient above 0.
double power_below(double coefficient) {
  return std::floor(std::log(coefficient) / std::log(kNodeRatio));
}

SimulatedLeak between(const SimulatedLeak& low, const SimulatedLeak& high, double coefficient) {
  const LeakCurve curve({low.point, high.point});
  const double t =
      (coefficient - low.point.coefficient) / (high.point.coefficient - low.point.coefficient);
  SimulatedLeak leak;
  leak.point.coefficient = coefficient;
  leak.point.share = curve.share(coefficient);
  leak.point.leak_flow_m3_per_s = curve.leak_flow_m3_per_s(coefficient);
  leak.point.share_slope = std::lerp(low.point.share_slope, high.point.share_slope, t);
  leak.point.flow_slope = std::lerp(low.point.flow_slope, high.point.flow_slope, t);
  leak.further_slope = low.further_slope + t * (high.further_slope - low.further_slope);
  return leak;
}

}  // namespace

SimulatedLeak LeakMemo::at(double coefficient, const Simulate& simulate) {
  if (between_ == Between::simulated) return simulated(coefficient, simulate, {});
  const double below = power_below(coefficient);
  try {
    const PeriodicEffort least = usual_effort(simulate);
    return between(simulated(node(below), simulate, least),
                   simulated(node(below + 1.0), simulate, least), coefficient);
  } catch (const NoResultError&) {
    // A node may lie beyond what can be simulated.
    return simulated(coefficient, simulate, {});
  }
}

PeriodicEffort LeakMemo::usual_effort(const Simulate& simulate) {
  if (!(typical_ > 0.0)) return {};
  return simulated(node(power_below(typical_)), simulate, {}).effort;
}

SimulatedLeak LeakMemo::simulated(double coefficient, const Simulate& simulate,
                                  PeriodicEffort least) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = leaks_.find(coefficient);
    if (found != leaks_.end()) return found->second;
  }
  SimulatedLeak leak = simulate(coefficient, least);
  const std::lock_guard lock(mutex_);
  return leaks_.emplace(coefficient, std::move(leak)).first->second;
}

}  // namespace rigcal::diagnosis
