#pragma once

#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// A condition's average and, on the same time base, a separate record of each repeat.
struct RepeatRecords {
  Record average;
  /// In the order of the files; empty for an averaged file or a single repeat.
  std::vector<Record> singles;
  /// For each single record, the times that it covers.
  std::vector<TimeWindow> covered;
};

/// Aligns and averages as average_of() does. Each single repeat is shifted to the common time base
/// in the same way. The standard deviation of each single record is the pooled one of the repeats.
///
/// @throws InputError  under the conditions of average_of()
RepeatRecords repeat_records(const Campaign& campaign, const Condition& condition,
                             std::vector<Repeat> repeats);

/// Loads the average and the single repeats of a condition.
/// @throws InputError  under the conditions of load_record(), or if samples are missing in the
///                     windows
RepeatRecords load_repeats(const Campaign& campaign, const Condition& condition);

}  // namespace rigcal::datasets
