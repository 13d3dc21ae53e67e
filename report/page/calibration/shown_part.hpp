#pragma once

#include <span>
#include <string>
#include <vector>

#include "report/store/stored.hpp"

// Selects what a page shows if there are many conditions or long records.

namespace rigcal::report {

/// Returns the indices of the conditions to show in full, in campaign order: all of them if there
/// are at most 40, otherwise the worst 20. Conditions that could not be simulated or scored are the
/// worst, followed by failed ones. Otherwise they are ranked by the fraction of the limits that
/// they use.
std::vector<std::size_t> shown_in_full(const std::vector<calib::ConditionResult>& conditions);

/// Returns the index of the first sample in the last two periods; 0 if the drive has no frequency
/// or the record is shorter.
std::size_t first_of_last_periods(const calib::ConditionResult& condition,
                                  std::span<const double> time_s);

/// Returns position or angle if it was compared, otherwise the first channel; empty if there is
/// none.
std::string shown_channel(const std::vector<calib::ConditionResult>& conditions);

}  // namespace rigcal::report
