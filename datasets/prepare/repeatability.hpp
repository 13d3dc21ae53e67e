#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/describe.hpp"
#include "datasets/record.hpp"
#include "metrics/noise_floor.hpp"

namespace rigcal::datasets {

/// How well the repeats of one condition agree in one channel, and the resulting noise floor for
/// any model.
struct Repeatability {
  Channel channel = Channel::position;
  std::string unit;         ///< SI unit of the channel
  int repeats = 1;          ///< number of repeats that have the channel
  double pooled_sd = 0.0;   ///< sd of one repeat; NaN if unknown
  double sd_of_mean = 0.0;  ///< standard deviation of the mean
  /// Empty if the sd is unknown or the channel is constant: a noise floor is then not defined.
  std::optional<metrics::NoiseFloor> noise_floor;
  RIGCAL_DESCRIBE(unit, repeats, pooled_sd, sd_of_mean, noise_floor)
};

/// Returns one entry per channel, in channel order. Offsets and outliers of the repeats concern the
/// whole condition; see `record.repeat_reports`.
std::vector<Repeatability> repeatability(const Record& record);

/// Returns the difference between the largest and the smallest offset of the repeats [s]; 0 for a
/// single repeat.
double offset_range_s(const Record& record);

/// Returns the sources of the repeats that were reported as outliers.
std::vector<std::string> outliers(const Record& record);

}  // namespace rigcal::datasets
