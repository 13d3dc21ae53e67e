#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

struct RecordLength {
  const Condition* condition = nullptr;
  double seconds = 0.0;
};

double seconds_of(const Record& record);

/// Returns one text per record; a text is empty unless the record ended before its run did. If all
/// repeats of a condition end early, they agree with each other, so only these rules detect it:
/// - The condition states a `duration`, and the record is shorter than 95 % of it. (A sample or two
///   may be missing, but not a period.)
/// - The record is shorter than three quarters of the longest record of the same generated signal
///   (waveform, frequencies, amplitude). In addition, the longest record must not be an exception:
///   at least two records, and more records than are this short, are within 5 % of its length.
std::vector<std::string> short_records(const std::vector<RecordLength>& lengths);

/// Adds these warnings to the records concerned.
void warn_of_short_records(const Campaign& campaign, const std::vector<Record*>& records);

}  // namespace rigcal::datasets
