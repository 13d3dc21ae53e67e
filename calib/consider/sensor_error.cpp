#include "calib/consider/sensor_error.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "model/solver/sensors.hpp"

namespace rigcal::calib {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Largest magnitude of the product of the distances to four equally spaced points within the
/// middle interval, in intervals^4: 9/16. A fourth difference divided by 4! times that is the
/// error of the cubic, and it is the difference of two neighbouring third divided differences
/// divided by four intervals.
constexpr double kCubicError = 9.0 / 16.0 / 4.0;

/// Third divided differences of the readings; element i belongs to readings i - 1 to i + 2, and is
/// zero where one of these is missing.
VectorXd third_differences(std::span<const double> t, const VectorXd& x) {
  VectorXd result = VectorXd::Zero(x.size());
  const auto slope = [&](Index i) {
    const auto k = static_cast<std::size_t>(i);
    return (x(i + 1) - x(i)) / (t[k + 1] - t[k]);
  };
  const auto curve = [&](Index i) {
    const auto k = static_cast<std::size_t>(i);
    return (slope(i + 1) - slope(i)) / (t[k + 2] - t[k]);
  };
  for (Index i = 1; i + 2 < x.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    result(i) = (curve(i) - curve(i - 1)) / (t[k + 2] - t[k - 1]);
  }
  return result;
}

/// Solves y' = (x - y) / lag exactly, with x a cubic between two times.
///
/// @return  y - x, shape (samples); std::nullopt if the cubics are not accurate enough
std::optional<VectorXd> lag_effect(std::span<const double> t, const VectorXd& x, double lag_s) {
  VectorXd effect = VectorXd::Zero(x.size());
  const VectorXd third = third_differences(t, x);
  double known_h = 0.0;
  double decay = 0.0;
  double errors = 0.0;
  for (Index i = 0; i + 1 < x.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double h = t[k + 1] - t[k];
    if (h != known_h) {
      known_h = h;
      decay = std::exp(-h / lag_s);
    }
    // Newton's form through readings i, i + 1, i - 1 and i + 2, or as many of these as exist.
    const double before = i > 0 ? t[k - 1] - t[k] : 0.0;
    const double slope = (x(i + 1) - x(i)) / h;
    const double curve = i > 0 ? (slope - (x(i) - x(i - 1)) / -before) / (h - before) : 0.0;
    const double p1 = slope - curve * h + third(i) * h * before;
    const double p2 = curve - third(i) * (h + before);
    const double p3 = third(i);
    // x - lag x' + lag^2 x'' - lag^3 x''' solves the equation, without x itself here.
    const double at_start = lag_s * (-p1 + lag_s * (2.0 * p2 - lag_s * 6.0 * p3));
    const double at_end = lag_s * (-(p1 + h * (2.0 * p2 + h * 3.0 * p3)) +
                                   lag_s * (2.0 * p2 + 6.0 * p3 * h - lag_s * 6.0 * p3));
    effect(i + 1) = at_end + decay * (effect(i) - at_start);
    if (i > 1) errors += std::pow(kCubicError * h * h * h * (third(i) - third(i - 1)), 2);
  }
  if (!(errors <= kLagError * kLagError * effect.squaredNorm())) return std::nullopt;
  return effect;
}

}  // namespace

bool changes_start(const model::Rig& rig, const model::ParameterValues& values,
                   model::Output output, int index) {
  if (rig.initial != model::InitialState::given) return false;
  const model::Sensor sensor = model::sensor_of(output, values);
  if (sensor.gain < 0 || (index != sensor.gain && index != sensor.offset)) return false;
  constexpr std::string_view kGain = "_gain";
  const std::string_view key = model::parameter_spec(values.plant, sensor.gain).key;
  const int initial = model::parameter_index(
      values.plant, "initial_" + std::string(key.substr(0, key.size() - kGain.size())));
  if (initial < 0) return false;
  // A pressure that is not given balances the load; a position always counts as a reading.
  return output == model::Output::position || output == model::Output::angle ||
         values.given[static_cast<std::size_t>(initial)];
}

std::optional<VectorXd> sensor_error(model::Output output, const model::ParameterValues& values,
                                     int index, double size, std::span<const double> times_s,
                                     const VectorXd& reading) {
  const model::Sensor sensor = model::sensor_of(output, values);
  if (sensor.gain < 0 || index < 0) return std::nullopt;
  if (std::isfinite(values.value[static_cast<std::size_t>(sensor.maximum)])) return std::nullopt;
  if (index == sensor.offset) return VectorXd::Constant(reading.size(), size);
  if (index == sensor.gain) {
    const double gain = values.value[static_cast<std::size_t>(sensor.gain)];
    const double offset = values.value[static_cast<std::size_t>(sensor.offset)];
    return VectorXd((reading.array() - offset) * (size / gain));
  }
  if (index == sensor.lag && sensor.lag_s == 0.0 && size > 0.0)
    return lag_effect(times_s, reading, size);
  return std::nullopt;
}

}  // namespace rigcal::calib
