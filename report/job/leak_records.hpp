#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/checks/record_warnings.hpp"
#include "datasets/prepare/single_repeats.hpp"

namespace rigcal::report {

/// Records in which leaks are searched.
struct LeakRecords {
  std::vector<datasets::RepeatRecords> conditions;
  std::vector<std::string> left_out;  ///< conditions that cannot be diagnosed, and why, in words

  std::vector<datasets::Record> averages() const;
};

/// Reads the repeats of every condition that can be diagnosed.
LeakRecords load_leak_records(const datasets::Campaign& campaign, int threads);

/// Doubts about recordings, with equal ones gathered.
std::vector<datasets::RecordWarning> gathered_doubts(const std::vector<datasets::Record>& averages);

/// Leak levels that --healthy names are normal, as if `level_class` said so.
///
/// @throws UsageError  no condition has such a level, or `level_class` says otherwise
void take_healthy(const std::vector<std::string>& levels, datasets::Campaign& campaign);

}  // namespace rigcal::report
