#include "calib/design/design_limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace rigcal::calib {
namespace {

enum LimitColumn : Eigen::Index { kAtPosition, kAtVelocity, kAtAcceleration, kAtCommand, kAtFlow };
constexpr std::array kLimited{model::Output::position, model::Output::velocity,
                              model::Output::acceleration, model::Output::command,
                              model::Output::servo_flow};

/// Returns the used fraction of the distance from the first position to an end of the stroke.
/// Beyond the end the result exceeds 1, even if the first position is already at the end.
double travelled(double first, double reached, double end) {
  const double way = std::abs(end - first);
  const double gone = end >= first ? reached - first : first - reached;
  if (way > 0.0) return std::max(gone / way, 0.0);
  constexpr double kRounding = 1e-9;  // [m]
  return gone > kRounding ? std::numeric_limits<double>::infinity() : 0.0;
}

}  // namespace

std::span<const model::Output> limited_outputs() { return kLimited; }

std::vector<LimitUse> limit_uses(const datasets::DesignSettings& settings,
                                 const Eigen::MatrixXd& run, std::span<const double> drive) {
  std::vector<LimitUse> uses;
  double lowest = run.col(kAtPosition).minCoeff();
  double highest = run.col(kAtPosition).maxCoeff();
  for (const double value : drive) {
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
  const double first = run(0, kAtPosition);
  const auto end_of = [&](const char* words, const datasets::StatedLimit& limit, double reached,
                          bool beyond) {
    uses.push_back({"stroke", words, "m", limit.value, reached, limit.where,
                    beyond ? std::numeric_limits<double>::infinity()
                           : travelled(first, reached, limit.value)});
  };
  end_of("lowest position", settings.lowest_m, lowest, first < settings.lowest_m.value);
  end_of("highest position", settings.highest_m, highest, first > settings.highest_m.value);
  const auto size_of = [&](const char* key, const char* words, const char* unit,
                           const std::optional<datasets::StatedLimit>& limit, LimitColumn column) {
    if (!limit) return;
    const double reached = run.col(column).cwiseAbs().maxCoeff();
    uses.push_back({key, words, unit, limit->value, reached, limit->where, reached / limit->value});
  };
  size_of("speed", "speed", "m/s", settings.speed_m_per_s, kAtVelocity);
  size_of("acceleration", "acceleration", "m/s2", settings.acceleration_m_per_s2, kAtAcceleration);
  size_of("command", "valve command", "V", settings.command_v, kAtCommand);
  size_of("flow", "flow of the servo valve", "m3/s", settings.flow_m3_per_s, kAtFlow);
  return uses;
}

double largest_share(const std::vector<LimitUse>& uses) {
  double largest = 0.0;
  for (const LimitUse& use : uses) largest = std::max(largest, use.share);
  return largest;
}

}  // namespace rigcal::calib
