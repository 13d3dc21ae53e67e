#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/checks/record_warnings.hpp"
#include "datasets/prepare/single_repeats.hpp"

namespace rigcal::report {

/// The records to be searched for leaks.
struct LeakRecords {
  std::vector<datasets::RepeatRecords> conditions;
  std::vector<std::string> left_out;  ///< conditions that cannot be diagnosed, with reasons

  std::vector<datasets::Record> averages() const;
};

/// Reads the repeats of every condition that can be diagnosed.
LeakRecords load_leak_records(const datasets::Campaign& campaign, int threads);

/// Collects the doubts about recordings, with identical ones combined.
std::vector<datasets::RecordWarning> gathered_doubts(const std::vector<datasets::Record>& averages);

/// Marks the leak levels from --healthy as normal, as if `level_class` said so.
///
/// @throws UsageError  if no condition has such a level, or `level_class` contradicts it
void take_healthy(const std::vector<std::string>& levels, datasets::Campaign& campaign);

}  // namespace rigcal::report
