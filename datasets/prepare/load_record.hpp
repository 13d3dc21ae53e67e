#pragma once

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Lists every file of a condition once, with its current state.
/// @throws InputError  if a pattern matches no file
std::vector<FileState> files_of(const Campaign& campaign, const Condition& condition);

/// Reads the files of one repeat and converts them to SI.
/// @throws InputError  if a file cannot be read or its content is wrong
Repeat load_repeat(const Campaign& campaign, const RepeatSource& source);

/// Reads every repeat of a condition, or its one file that is already averaged.
/// @throws InputError  if a file is wrong, or there is none
std::vector<Repeat> load_all_repeats(const Campaign& campaign, const Condition& condition);

/// Averages the repeats of a condition with the campaign's settings.
/// @param repeats  modified in place first: decimated and cleared of spikes, if the campaign asks
///                 for it
/// @param keep_deviations  whether to keep the deviation of each repeat from the mean
/// @throws InputError  if the repeats do not belong together
Record average_of(const Campaign& campaign, const Condition& condition,
                  std::vector<Repeat>& repeats, bool keep_deviations = false);

/// Reads every repeat of a condition and averages them.
/// @throws InputError  if a file is wrong, or if the repeats do not belong together
Record load_record(const Campaign& campaign, const Condition& condition,
                   bool keep_deviations = false);

/// Loads the records of all conditions whose use is among `uses`, in the campaign's order. Files
/// are read in parallel.
/// @throws InputError  under the conditions of load_record(), or if samples are missing in the
///                     windows of a record
std::vector<Record> load_records(const Campaign& campaign, const std::vector<Use>& uses,
                                 int threads, bool keep_deviations = false);

/// Drops the deviations of single repeats that load_records() kept.
void drop_deviations(std::vector<Record>& records);

}  // namespace rigcal::datasets
