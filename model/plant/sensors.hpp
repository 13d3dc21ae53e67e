#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "model/plant/parameter.hpp"
#include "model/simulate.hpp"

namespace rigcal::model {

/// Response of a sensor: y' = (x - y) / lag from y = x at the first sample, then reading = gain y +
/// offset, at most `maximum`. Indices are rows of the parameter table.
struct Sensor {
  int gain = -1;
  int offset = -1;
  int lag = -1;
  int maximum = -1;
  double lag_s = 0.0;  ///< 0: none
};

/// The sensor of an output; indices of -1 where it has none (velocity, spool, flows).
Sensor sensor_of(Output output, const ParameterValues& values);

/// Times at which the outputs are needed to compute the sensors: the sample times, and as many
/// between them as the shortest lag requires.
struct SensorTimes {
  std::vector<double> times_s;
  std::vector<std::size_t> sample;  ///< position of each sample time in times_s
};
/// None where no sensor lags: then the sample times are all that is needed.
std::optional<SensorTimes> sensor_times(std::span<const Output> outputs,
                                        const ParameterValues& values,
                                        std::span<const double> samples_s);

/// Converts quantities at the times of `at` into readings at its samples, with the sensitivities to
/// the sensors' own parameters among `free`. Between two times a quantity is interpolated linearly.
/// A reading at its maximum depends on nothing, so a saturated record is not fitted.
///
/// @param at   sensor_times() of the samples
/// @param run  an ok run with a matrix row for each time; afterwards it has one for each sample
void read_sensors(const std::optional<SensorTimes>& at, std::span<const Output> outputs,
                  const ParameterValues& values, std::span<const int> free, Simulation& run);

}  // namespace rigcal::model
