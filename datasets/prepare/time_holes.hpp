#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Steps of time above three times their median, between samples `time_s`, shape (samples).
std::vector<TimeHole> time_holes(const std::vector<double>& time_s);

/// In words, per repeat: where samples are missing in what counts, with the file, its row and the
/// times. A hole that no window touches takes nothing away, unless a recorded drive opens the loop:
/// nobody knows what it did there, and the piston stays where it took it.
///
/// @param repeats  as they came from their files
/// @param windows  what counts; empty: all of it
std::vector<std::string> holes_in_what_counts(const Campaign& campaign, const Condition& condition,
                                              const std::vector<Repeat>& repeats,
                                              const std::vector<TimeWindow>& windows);

/// @throws InputError  samples are missing in what counts
void require_no_holes(const Campaign& campaign, const Record& record);

}  // namespace rigcal::datasets
