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
  /// Per single the times that it covers.
  std::vector<TimeWindow> covered;
};

/// Aligns and averages as average_of(); a single repeat is shifted to the common time base as it is
/// for the average. Its standard deviation is the pooled one of the repeats.
///
/// @throws InputError  as average_of()
RepeatRecords repeat_records(const Campaign& campaign, const Condition& condition,
                             std::vector<Repeat> repeats);

/// Loads the average and the single repeats of a condition.
/// @throws InputError  as load_record(); samples are missing in the windows
RepeatRecords load_repeats(const Campaign& campaign, const Condition& condition);

}  // namespace rigcal::datasets
