#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Length of a condition's record.
struct RecordLength {
  const Condition* condition = nullptr;
  double seconds = 0.0;
};

double seconds_of(const Record& record);

/// What tells, in words, that a record ended before its run did; per record, empty where nothing
/// does. Repeats of one condition that all end early agree with each other, so that only this
/// tells:
/// - the condition states a `duration`, and the record is shorter than 95 % of it (a sample or two
///   may be missing, no period); or
/// - it is shorter than three quarters of the longest record of the same generated signal
///   (waveform, frequencies, amplitude), and two or more, and more than are so short, are as long
///   as that within 5 %. Fewer do not tell which length was meant.
std::vector<std::string> short_records(const std::vector<RecordLength>& lengths);

/// Adds that warning to the records it is about.
void warn_of_short_records(const Campaign& campaign, const std::vector<Record*>& records);

}  // namespace rigcal::datasets
