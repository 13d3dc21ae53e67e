#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Gives a repeat the samples that its file lacks, where the campaign bridges holes (`holes =
/// "bridge"`): in each step of time above 1.5 times the median, up to `longest_hole`, as many as
/// are missing, evenly apart. They are marked as `bridged`: what stands there, a line between the
/// neighbours or a held input, keeps filters and shifts going and is compared with nothing.
/// Without such a request it does nothing.
///
/// @throws InputError  more samples are missing than there are
void bridge_holes(const Campaign& campaign, Repeat& repeat);

/// Marks as NaN what shifted() made of bridged samples.
///
/// @param row    as shifted(values, shift, ...) gave it
void forget_bridged(std::vector<double>& row, const std::vector<bool>& bridged, double shift);

/// What was bridged, in words, a text per repeat.
std::vector<std::string> bridged_notes(const std::vector<Repeat>& repeats);

/// In words: where none of the repeats tells what a recorded drive did; empty if nowhere.
std::string guessed_drive_warning(const Campaign& campaign, const Condition& condition,
                                  const Record& record);

}  // namespace rigcal::datasets
