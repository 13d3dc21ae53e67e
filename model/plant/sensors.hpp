#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "model/plant/parameter.hpp"
#include "model/simulate.hpp"

namespace rigcal::model {

/// What a sensor makes of a quantity: y' = (x - y) / lag from y = x at the first sample, then
/// reading = gain y + offset, `maximum` at most. Indices are rows of the parameter table.
struct Sensor {
  int gain = -1;
  int offset = -1;
  int lag = -1;
  int maximum = -1;
  double lag_s = 0.0;  ///< 0: none
};

/// The sensor of an output; indices of -1 where it has none (velocity, spool, flows).
Sensor sensor_of(Output output, const ParameterValues& values);

/// Times at which the outputs must be known so that their sensors can be followed: the sample
/// times, and between them as many as the shortest lag asks for.
struct SensorTimes {
  std::vector<double> times_s;
  std::vector<std::size_t> sample;  ///< position of each sample time in times_s
};
/// None where no sensor lags: then the sample times are all that is needed.
std::optional<SensorTimes> sensor_times(std::span<const Output> outputs,
                                        const ParameterValues& values,
                                        std::span<const double> samples_s);

/// Turns quantities at the times of `at` into readings at its samples, with the sensitivities to
/// the sensors' own parameters among `free`. Between two times a quantity is taken to be straight.
/// A reading at its maximum depends on nothing: a record that stands there too is not fitted.
///
/// @param at   sensor_times() of the samples
/// @param run  an ok one, its matrices with a row for each time; afterwards for each sample
void read_sensors(const std::optional<SensorTimes>& at, std::span<const Output> outputs,
                  const ParameterValues& values, std::span<const int> free, Simulation& run);

}  // namespace rigcal::model
