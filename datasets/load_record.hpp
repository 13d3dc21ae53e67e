#pragma once

#include "datasets/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Reads the files of one repeat and converts them to SI.
/// @throws InputError
Repeat load_repeat(const Campaign& campaign, const RepeatSource& source);

/// Reads every repeat of a condition and averages them.
/// @throws InputError  a file is wrong, or the repeats do not belong together
Record load_record(const Campaign& campaign, const Condition& condition);

/// Records of all conditions whose use is among `uses`, in the campaign's order; files are read in
/// parallel.
std::vector<Record> load_records(const Campaign& campaign, const std::vector<Use>& uses,
                                 int threads);

}  // namespace rigcal::datasets
