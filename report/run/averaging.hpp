#pragma once

#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"
#include "report/store/folder.hpp"
#include "report/store/stored/stored_record.hpp"

namespace rigcal::report {

/// The record of every condition that has one and is not ignored, in the campaign's order, warned
/// about where it is short beside the others.
///
/// @throws InputError  a record is wrong, or there is none
std::vector<datasets::Record> averaged_records(const datasets::Campaign& campaign);

/// Files that write_average() may write, for HeldFolder::plan() before the work.
PlannedFiles planned_average(const datasets::Campaign& campaign);

/// Writes averaged/<condition>.csv of each, repeatability.csv, average.json and the page.
///
/// @param threads     that draw the page
/// @param provenance  but for the inputs
/// @return            average.json
/// @throws WriteError, UsageError  as write_results()
StoredAverage write_average(HeldFolder& held, int threads, const datasets::Campaign& campaign,
                            const std::vector<datasets::Record>& records, Provenance provenance);

}  // namespace rigcal::report
