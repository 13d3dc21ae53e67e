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

/// Warns, in words, if a record ended before its run did; one text per record, empty if it did not.
/// If all repeats of one condition end early they agree with each other, so only these rules detect
/// it:
/// - The condition states a `duration`, and the record is shorter than 95 % of it (a sample or two
///   may be missing, but no period).
/// - The record is shorter than three quarters of the longest record of the same generated signal
///   (waveform, frequencies, amplitude). In addition, at least two records, and more than are so
///   short, are as long as that one within 5 %. Fewer do not show which length was intended.
std::vector<std::string> short_records(const std::vector<RecordLength>& lengths);

/// Adds that warning to the records it is about.
void warn_of_short_records(const Campaign& campaign, const std::vector<Record*>& records);

}  // namespace rigcal::datasets
