#pragma once

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Every file of a condition, once, with its present state.
/// @throws InputError  a pattern that matches no file
std::vector<FileState> files_of(const Campaign& campaign, const Condition& condition);

/// Reads the files of one repeat and converts them to SI.
/// @throws InputError
Repeat load_repeat(const Campaign& campaign, const RepeatSource& source);

/// Reads every repeat of a condition, or the one file that is averaged already.
/// @throws InputError  a file is wrong, or there is none
std::vector<Repeat> load_all_repeats(const Campaign& campaign, const Condition& condition);

/// Averages the repeats of a condition with the campaign's settings.
/// @param repeats  decimated and cleared of spikes first, if the campaign says so
/// @param keep_deviations  keep those of each repeat from the mean
/// @throws InputError  the repeats do not belong together
Record average_of(const Campaign& campaign, const Condition& condition,
                  std::vector<Repeat>& repeats, bool keep_deviations = false);

/// Reads every repeat of a condition and averages them.
/// @throws InputError  a file is wrong, or the repeats do not belong together
Record load_record(const Campaign& campaign, const Condition& condition,
                   bool keep_deviations = false);

/// Records of all conditions whose use is among `uses`, in the campaign's order; files are read in
/// parallel.
/// @throws InputError  as load_record(); samples are missing in the windows of a record
std::vector<Record> load_records(const Campaign& campaign, const std::vector<Use>& uses,
                                 int threads, bool keep_deviations = false);

/// Drops the single repeats that load_records() kept.
void drop_deviations(std::vector<Record>& records);

}  // namespace rigcal::datasets
