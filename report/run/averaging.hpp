#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"
#include "report/store/folder.hpp"

namespace rigcal::report {

/// The record of every condition that has one and is not ignored, in the campaign's order, warned
/// about where it is short beside the others.
///
/// @throws InputError  a record is wrong, or there is none
std::vector<datasets::Record> averaged_records(const datasets::Campaign& campaign);

/// averaged/<condition>.csv of each, and repeatability.csv.
std::vector<ResultFile> averaged_files(const std::vector<datasets::Record>& records);

}  // namespace rigcal::report
