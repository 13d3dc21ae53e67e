#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// A stretch of one repeat in which a sensor wrongly gave a constant value.
struct SensorFault {
  enum class Kind { clipped_at_highest, clipped_at_lowest, frozen };
  Channel channel = Channel::position;
  Kind kind = Kind::frozen;
  std::string source;  ///< as in Repeat::source
  TimeWindow stretch;  ///< from its first sample to its last
  std::size_t samples = 0;
  double value = 0.0;
};

/// Finds the parts of a record in which sensors of output channels were clipped or frozen. Without
/// a drive (recorded, or a generated sine or square), a faulty sensor cannot be distinguished from
/// a rig at rest, so nothing is found.
///
/// @param repeats  as recorded, in SI
std::vector<SensorFault> sensor_faults(const Campaign& campaign, const Condition& condition,
                                       const std::vector<Repeat>& repeats);

/// Describes the faults within the windows of the record, with one text for each channel and kind.
///
/// @param windows  windows of the record; empty: the whole record
std::vector<std::string> sensor_warnings(const std::vector<SensorFault>& faults,
                                         const std::vector<TimeWindow>& windows);

}  // namespace rigcal::datasets
