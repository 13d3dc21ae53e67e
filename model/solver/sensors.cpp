#include "model/solver/sensors.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace rigcal::model {
namespace {

/// Minimum number of times per lag. Linear interpolation between them is then accurate to 1e-3 of
/// any signal that the sensor can follow.
constexpr double kTimesPerLag = 8.0;
/// Maximum number of pieces of a sample interval. A lag that would need more has no noticeable
/// effect.
constexpr double kMostBetweenSamples = 256.0;

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
    default:
      return {};
  }
}

/// Solves y' = (x - y) / lag exactly, with x linear between two times, and computes dy / d lag.
void follow(const Eigen::VectorXd& x, std::span<const double> times_s, double lag_s,
            Eigen::VectorXd& y, Eigen::VectorXd& y_by_lag) {
  y.resize(x.size());
  y_by_lag.setZero(x.size());
  y(0) = x(0);
  for (Eigen::Index k = 1; k < x.size(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double h = times_s[i] - times_s[i - 1];
    const double decay = std::exp(-h / lag_s);
    const double decay_by_lag = decay * h / (lag_s * lag_s);
    const double slope = (x(k) - x(k - 1)) / h;
    y(k) = decay * (y(k - 1) - x(k - 1)) + x(k) - slope * lag_s * (1.0 - decay);
    y_by_lag(k) = decay * y_by_lag(k - 1) + decay_by_lag * (y(k - 1) - x(k - 1)) -
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
                                        const ParameterValues& values,
                                        std::span<const double> samples_s) {
  double shortest_s = 0.0;
  for (const Output output : outputs) {
    const double lag_s = sensor_of(output, values).lag_s;
    if (lag_s > 0.0 && (shortest_s == 0.0 || lag_s < shortest_s)) shortest_s = lag_s;
  }
  if (shortest_s == 0.0) return std::nullopt;
  SensorTimes result;
  for (std::size_t i = 0; i < samples_s.size(); ++i) {
    if (i > 0) {
      const double h = samples_s[i] - samples_s[i - 1];
      const double wanted = std::ceil(kTimesPerLag * h / shortest_s);
      const int pieces = static_cast<int>(std::clamp(wanted, 1.0, kMostBetweenSamples));
      for (int piece = 1; piece < pieces; ++piece) {
        result.times_s.push_back(samples_s[i - 1] + h * piece / pieces);
      }
    }
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
    if (sensor.lag_s > 0.0) {
      Eigen::VectorXd y;
      Eigen::VectorXd unused;
      for (Eigen::Index j = 0; j < by.cols(); ++j) {
        follow(by.col(j), at->times_s, sensor.lag_s, y, unused);
        by.col(j) = y;
      }
      follow(column, at->times_s, sensor.lag_s, y, by_lag);
      column = y;
    }
    const double gain = values.value[static_cast<std::size_t>(sensor.gain)];
    const double offset = values.value[static_cast<std::size_t>(sensor.offset)];
    if (gain != 1.0) by *= gain;
    for (std::size_t j = 0; j < free.size(); ++j) {
      auto direction = by.col(static_cast<Eigen::Index>(j));
      if (free[j] == sensor.gain) direction += column;
      if (free[j] == sensor.offset) direction.array() += 1.0;
      if (free[j] == sensor.lag && sensor.lag_s > 0.0) direction += gain * by_lag;
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
