#pragma once

#include <span>
#include <string>
#include <vector>

#include "report/store/stored.hpp"

// What a page shows of many conditions and of long records.

namespace rigcal::report {

/// The indices of the conditions that are shown in full, in the order of the campaign: all if there
/// are up to 40, otherwise the worst 20. A condition that could not be simulated or scored is worse
/// than one that fails, and then the portion of its limits that it uses counts.
std::vector<std::size_t> shown_in_full(const std::vector<StoredCondition>& conditions);

/// Index of the first sample of the last two periods; 0 if the drive has no frequency or the record
/// is shorter.
std::size_t first_of_last_periods(const StoredCondition& condition, std::span<const double> time_s);

/// Position or angle if it was compared, otherwise the first channel; empty if there is none.
std::string shown_channel(const std::vector<StoredCondition>& conditions);

}  // namespace rigcal::report
