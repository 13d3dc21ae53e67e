#include "model/solver/sensors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "model/plant/lag.hpp"

namespace rigcal::model {
namespace {

/// Minimum number of times per lag. Linear interpolation between them is then accurate to 1e-3 of
/// any signal that the sensor can follow.
constexpr double kTimesPerLag = 8.0;
/// Maximum number of equal pieces of a sample interval. For a lag that would need more, only the
/// end of the interval matters, so the times then become denser towards each sample.
constexpr double kMostBetweenSamples = 256.0;
/// Ratio of the distances of two such times from the sample. Linear interpolation between them is
/// off by 0.04 lag^2 x'', which is at most 4e-3 of the lag's effect on any sampled signal.
constexpr double kFartherFromSample = 1.5;
/// The first such time, in lags before the sample.
constexpr double kFirstBeforeSample = 0.5;
/// Two times closer than this fraction of that distance are one.
constexpr double kSameTime = 0.1;
/// Relative difference up to which two intervals between times count as equal. Rounding of the
/// times leaves less, and an exponential takes longer than all else that a lag needs.
constexpr double kSameInterval = 1e-7;

std::string_view sensor_name(Output output) {
  switch (output) {
    case Output::position:
      return "position";
    case Output::load_pressure:
      return "load_pressure";
    case Output::pressure_a:
      return "pressure_a";
    case Output::pressure_b:
      return "pressure_b";
    case Output::force:
      return "force";
    case Output::acceleration:
      return "acceleration";
    case Output::payload_acceleration:
      return "payload_acceleration";
    case Output::angle:
      return "angle";
    case Output::torque:
      return "torque";
    default:
      return {};
  }
}

/// The lags that a run has to follow, at least kLeastLag_s each. A free lag of zero is one of them,
/// because its sensitivity needs the slope of the quantity.
std::vector<double> lags_to_follow(std::span<const Output> outputs, const ParameterValues& values,
                                   std::span<const int> free) {
  std::vector<double> lags_s;
  for (const Output output : outputs) {
    const Sensor sensor = sensor_of(output, values);
    if (sensor.follows(free)) lags_s.push_back(std::max(sensor.lag_s, kLeastLag_s));
  }
  return lags_s;
}

/// Appends the times between two samples in ascending order: equal pieces for the lags that they
/// can follow, and times that become denser towards the later sample for shorter lags.
void append_between(double from_s, double to_s, std::span<const double> lags_s,
                    std::vector<double>& times_s) {
  const double h = to_s - from_s;
  double shortest_s = std::numeric_limits<double>::infinity();  // long enough for pieces
  double too_short_s = std::numeric_limits<double>::infinity();
  for (const double lag_s : lags_s) {
    double& least_s = kTimesPerLag * h > kMostBetweenSamples * lag_s ? too_short_s : shortest_s;
    least_s = std::min(least_s, lag_s);
  }
  const std::size_t first = times_s.size();
  const int pieces = std::max(1, static_cast<int>(std::ceil(kTimesPerLag * h / shortest_s)));
  for (int piece = 1; piece < pieces; ++piece) times_s.push_back(from_s + h * piece / pieces);
  if (std::isinf(too_short_s)) return;
  const double nearest_s = kFirstBeforeSample * too_short_s;
  for (double before_s = nearest_s; before_s + nearest_s < h; before_s *= kFartherFromSample)
    times_s.push_back(to_s - before_s);
  const auto begin = times_s.begin() + static_cast<std::ptrdiff_t>(first);
  std::sort(begin, times_s.end());
  const auto same = [same_s = kSameTime * nearest_s](double earlier, double later) {
    return later - earlier < same_s;
  };
  times_s.erase(std::unique(begin, times_s.end(), same), times_s.end());
}

/// Solves y' = (x - y) / lag exactly, with x linear between two times, and computes dy / d lag. For
/// a lag of zero y is x, and the derivative is -x'.
///
/// @param y_by_lag  null if the derivative is not needed
void follow(const Eigen::VectorXd& x, std::span<const double> times_s, double lag_s,
            Eigen::VectorXd& y, Eigen::VectorXd* y_by_lag) {
  y.resize(x.size());
  if (y_by_lag != nullptr) y_by_lag->setZero(x.size());
  y(0) = x(0);
  double known_h = 0.0;
  double decay = 0.0;
  for (Eigen::Index k = 1; k < x.size(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double h = times_s[i] - times_s[i - 1];
    if (std::abs(h - known_h) > kSameInterval * h) {
      known_h = h;
      decay = lag_s > 0.0 ? std::exp(-h / lag_s) : 0.0;
    }
    const double slope = (x(k) - x(k - 1)) / h;
    y(k) = decay * (y(k - 1) - x(k - 1)) + x(k) - slope * lag_s * (1.0 - decay);
    if (y_by_lag == nullptr) continue;
    const double decay_by_lag = decay > 0.0 ? decay * h / (lag_s * lag_s) : 0.0;
    (*y_by_lag)(k) = decay * (*y_by_lag)(k - 1) + decay_by_lag * (y(k - 1) - x(k - 1)) -
                     slope * (1.0 - decay - lag_s * decay_by_lag);
  }
}

Eigen::MatrixXd at_samples(const SensorTimes& at, const Eigen::MatrixXd& all) {
  const auto samples = static_cast<Eigen::Index>(at.sample.size());
  Eigen::MatrixXd kept(samples, all.cols());
  if (all.cols() == 0) return kept;  // a matrix without columns has no rows to copy
  for (Eigen::Index i = 0; i < samples; ++i)
    kept.row(i) = all.row(static_cast<Eigen::Index>(at.sample[static_cast<std::size_t>(i)]));
  return kept;
}

}  // namespace

bool Sensor::follows(std::span<const int> free) const {
  return lag_s > 0.0 || (lag >= 0 && std::find(free.begin(), free.end(), lag) != free.end());
}

Sensor sensor_of(Output output, const ParameterValues& values) {
  const std::string name(sensor_name(output));
  if (name.empty()) return {};
  const auto index = [&](const char* what) { return parameter_index(values.plant, name + what); };
  Sensor sensor{index("_gain"), index("_offset"), index("_lag"), index("_maximum"), 0.0};
  if (sensor.gain < 0) return {};  // the plant does not have that sensor
  const auto lag = static_cast<std::size_t>(sensor.lag);
  if (values.given[lag]) sensor.lag_s = values.value[lag];
  return sensor;
}

std::optional<SensorTimes> sensor_times(std::span<const Output> outputs,
                                        const ParameterValues& values, std::span<const int> free,
                                        std::span<const double> samples_s) {
  const std::vector<double> lags_s = lags_to_follow(outputs, values, free);
  if (lags_s.empty()) return std::nullopt;
  SensorTimes result;
  result.sample.reserve(samples_s.size());
  for (std::size_t i = 0; i < samples_s.size(); ++i) {
    if (i > 0) append_between(samples_s[i - 1], samples_s[i], lags_s, result.times_s);
    result.sample.push_back(result.times_s.size());
    result.times_s.push_back(samples_s[i]);
  }
  return result;
}

void read_sensors(const std::optional<SensorTimes>& at, std::span<const Output> outputs,
                  const ParameterValues& values, std::span<const int> free, Simulation& run) {
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    const Sensor sensor = sensor_of(outputs[k], values);
    if (sensor.gain < 0) continue;
    auto column = run.outputs.col(static_cast<Eigen::Index>(k));
    Eigen::MatrixXd& by = run.sensitivities[k];
    Eigen::VectorXd by_lag;
    const bool follows = sensor.follows(free);
    if (follows) {
      const bool is_free = std::find(free.begin(), free.end(), sensor.lag) != free.end();
      Eigen::VectorXd y;
      for (Eigen::Index j = 0; j < by.cols(); ++j) {
        follow(by.col(j), at->times_s, sensor.lag_s, y, nullptr);
        by.col(j) = y;
      }
      follow(column, at->times_s, sensor.lag_s, y, is_free ? &by_lag : nullptr);
      column = y;
    }
    const double gain = values.value[static_cast<std::size_t>(sensor.gain)];
    const double offset = values.value[static_cast<std::size_t>(sensor.offset)];
    if (gain != 1.0) by *= gain;
    for (std::size_t j = 0; j < free.size(); ++j) {
      auto direction = by.col(static_cast<Eigen::Index>(j));
      if (free[j] == sensor.gain) direction += column;
      if (free[j] == sensor.offset) direction.array() += 1.0;
      if (follows && free[j] == sensor.lag) direction += gain * by_lag;
    }
    if (gain != 1.0 || offset != 0.0) column = (gain * column.array() + offset).matrix();
    const double maximum = values.value[static_cast<std::size_t>(sensor.maximum)];
    if (!std::isfinite(maximum)) continue;
    for (Eigen::Index i = 0; i < column.size(); ++i) {
      if (!(column(i) > maximum)) continue;
      column(i) = maximum;
      if (by.cols() > 0) by.row(i).setZero();
    }
  }
  if (!at || at->times_s.size() == at->sample.size()) return;
  run.outputs = at_samples(*at, run.outputs);
  for (Eigen::MatrixXd& by : run.sensitivities) by = at_samples(*at, by);
}

}  // namespace rigcal::model
