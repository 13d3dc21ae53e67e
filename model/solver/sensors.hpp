#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "model/plant/parameter.hpp"
#include "model/plant/rig.hpp"
#include "model/solver/simulation.hpp"

namespace rigcal::model {

/// Response of a sensor: y' = (x - y) / lag, with y = x at the first sample. The reading is
/// gain y + offset, limited to `maximum`. Indices refer to rows of the parameter table.
struct Sensor {
  int gain = -1;
  int offset = -1;
  int lag = -1;
  int maximum = -1;
  double lag_s = 0.0;  ///< 0: no lag

  /// Whether a run with sensitivities to the parameters in `free` has to follow the lag: it is
  /// above zero or free.
  bool follows(std::span<const int> free) const;
};

/// Returns the sensor of an output. Its indices are -1 for outputs without a sensor (velocity,
/// spool, flows).
Sensor sensor_of(Output output, const ParameterValues& values);

/// Times at which the sensor computation needs the outputs: the sample times, and as many in
/// between as the lags require.
struct SensorTimes {
  std::vector<double> times_s;
  std::vector<std::size_t> sample;  ///< index of each sample time in times_s
};
/// Returns std::nullopt if no sensor has a lag or a free one. The sample times are then sufficient.
///
/// @param free  table indices of the parameters with sensitivities
std::optional<SensorTimes> sensor_times(std::span<const Output> outputs,
                                        const ParameterValues& values, std::span<const int> free,
                                        std::span<const double> samples_s);

/// Converts the physical quantities of a run into sensor readings, with sensitivities to the sensor
/// parameters in `free`. The quantities are interpolated linearly between the times in `at` and
/// read at its samples. A saturated reading has no sensitivities, so saturated samples are not
/// fitted.
///
/// @param at   sensor_times() of the samples, with the same `free`
/// @param run  a successful run with one matrix row per time; on return it has one row per sample
void read_sensors(const std::optional<SensorTimes>& at, std::span<const Output> outputs,
                  const ParameterValues& values, std::span<const int> free, Simulation& run);

}  // namespace rigcal::model
