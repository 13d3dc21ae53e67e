#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/record.hpp"
#include "metrics/noise_floor.hpp"

namespace rigcal::datasets {

/// Agreement of the repeats of one condition in one channel, and the noise floor that follows for
/// any model.
struct Repeatability {
  std::string condition;
  Channel channel = Channel::position;
  int repeats = 1;          ///< number of repeats with the channel
  double pooled_sd = 0.0;   ///< for one repeat, SI unit of the channel; NaN if unknown
  double sd_of_mean = 0.0;  ///< standard deviation of their mean
  /// Empty where the sd is unknown or the channel constant: then there is no such number.
  std::optional<metrics::NoiseFloor> noise_floor;
};

/// One entry per channel, in the order of the channels. Offsets and outliers of the repeats belong
/// to the whole condition: `record.repeat_reports`.
std::vector<Repeatability> repeatability(const Record& record);

/// Largest minus smallest offset of the repeats [s]; 0 for a single one.
double offset_range_s(const Record& record);

/// Sources of the repeats that were named outliers.
std::vector<std::string> outliers(const Record& record);

}  // namespace rigcal::datasets
