#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Returns the median time step of at least two samples.
double median_step(const std::vector<double>& time_s);

/// Finds time steps longer than three times the median. `time_s` has the shape (samples).
std::vector<TimeHole> time_holes(const std::vector<double>& time_s);

/// Describes, for each repeat, the holes that affect the result, with file, row and times. A hole
/// outside all windows is harmless unless the drive is a recorded command in open loop. The unknown
/// command during the hole then displaces the piston permanently.
///
/// @param repeats  as read from their files
/// @param windows  windows of the condition; empty: the whole record
std::vector<std::string> holes_in_what_counts(const Campaign& campaign, const Condition& condition,
                                              const std::vector<Repeat>& repeats,
                                              const std::vector<TimeWindow>& windows);

/// @throws InputError  if samples are missing in the windows of the record
void require_no_holes(const Campaign& campaign, const Record& record);

}  // namespace rigcal::datasets
