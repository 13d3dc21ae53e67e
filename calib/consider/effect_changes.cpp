#include "calib/consider/effect_changes.hpp"

#include <algorithm>
#include <cmath>

#include "common/parallel.hpp"

namespace rigcal::calib {
namespace {

std::size_t place_of(const EffectCovariance& effects, const std::string& key) {
  return static_cast<std::size_t>(std::find(effects.keys.begin(), effects.keys.end(), key) -
                                  effects.keys.begin());
}

/// Returns the time derivative, by central differences.
std::vector<double> rate(std::span<const double> x, std::span<const double> time_s) {
  std::vector<double> result(x.size(), 0.0);
  for (std::size_t i = 0; i < x.size() && x.size() > 1; ++i) {
    const std::size_t before = i > 0 ? i - 1 : i;
    const std::size_t after = std::min(i + 1, x.size() - 1);
    result[i] = (x[after] - x[before]) / (time_s[after] - time_s[before]);
  }
  return result;
}

}  // namespace

std::vector<Effect> considered_in(const Problem& problem, std::span<const double> z,
                                  const EffectCovariance& effects) {
  if (effects.empty()) return {};
  std::vector<Effect> acting = effects_of(problem, z);
  std::erase_if(acting, [&](const Effect& each) {
    return place_of(effects, each.about.key) == effects.keys.size();
  });
  for (Effect& each : acting) {
    if (each.curved)
      each.secant = std::max(effects.size(each.about.key) / each.about.size, kLeastSecant);
  }
  return acting;
}

EffectChanges changes_by(const Problem& problem, std::size_t condition,
                         const model::ParameterValues& values, const std::vector<Effect>& acting,
                         const EffectCovariance& effects, const std::atomic<bool>* cancel,
                         std::span<const model::Output> further) {
  const std::span<const double> times_s = problem.conditions[condition].record->time_s;
  const auto found = effect_changes(problem, condition, values, times_s, acting, cancel, further);
  EffectChanges result;
  for (const Eigen::MatrixXd& channel : found) {
    Eigen::MatrixXd& own = result.emplace_back(
        Eigen::MatrixXd::Zero(channel.rows(), static_cast<Eigen::Index>(effects.keys.size())));
    for (std::size_t e = 0; e < acting.size(); ++e) {
      const auto place = static_cast<Eigen::Index>(place_of(effects, acting[e].about.key));
      own.col(place) = channel.col(static_cast<Eigen::Index>(e)) / acting[e].about.size;
    }
  }
  return result;
}

std::vector<EffectChanges> predicted_changes(const Problem& problem, std::span<const double> z,
                                             const EffectCovariance& effects, int threads,
                                             const std::atomic<bool>* cancel) {
  if (effects.empty()) return {};
  const std::vector<Effect> acting = considered_in(problem, z, effects);
  std::vector<EffectChanges> result(problem.conditions.size());
  parallel_for(result.size(), threads, [&](std::size_t i) {
    if (problem.conditions[i].condition->use == datasets::Use::fit) return;
    result[i] = changes_by(problem, i, problem.values_at(i, z), acting, effects, cancel);
  });
  return result;
}

std::vector<SensorChange> sensor_changes(datasets::Channel channel,
                                         const std::vector<Effect>& acting,
                                         const EffectCovariance& effects,
                                         std::span<const double> simulated,
                                         std::span<const double> time_s) {
  std::vector<SensorChange> result;
  for (const Effect& effect : acting) {
    const std::string& key = effect.about.key;
    const double size = effects.size(key);
    if (sensor_channel(key) != channel || !(size > 0.0)) continue;
    std::vector<double>& change =
        result.emplace_back(SensorChange{key, std::vector<double>(simulated.size(), size)}).change;
    if (effect.is_of_sensor()) {
      const Eigen::Map<const Eigen::VectorXd> reading(simulated.data(),
                                                      static_cast<Eigen::Index>(simulated.size()));
      const Eigen::VectorXd off = reading_error(effect, reading, size);
      change.assign(off.begin(), off.end());
    } else if (key.ends_with("_lag")) {
      const std::vector<double> speed = rate(simulated, time_s);
      for (std::size_t i = 0; i < change.size(); ++i) change[i] = -size * speed[i];
    } else if (key.ends_with("_gain")) {
      for (std::size_t i = 0; i < change.size(); ++i) change[i] = size * simulated[i];
    }
  }
  return result;
}

}  // namespace rigcal::calib
