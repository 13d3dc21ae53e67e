#pragma once

#include <filesystem>
#include <string>

#include "datasets/campaign/campaign.hpp"
#include "datasets/read/record_table.hpp"

namespace rigcal::datasets {

/// Compares the unit that a file gives for a column with that of the campaign. Files give units in
/// the name (in brackets or after an underscore), in a row of units, or in an attribute. Units are
/// equal if they convert with a factor of 1 within 1e-6. A gain that performs the conversion,
/// within 5 %, is no contradiction; nor is any gain between different dimensions. Texts that are no
/// unit are ignored, and so are names that only look like a unit of another dimension ("p_in" in
/// bar).
///
/// @param key  channel in the campaign file: "position"
/// @throws InputError  the units contradict each other (names both, with file, place and key)
void require_stated_unit(const StatedUnit& stated, const std::string& key,
                         const std::filesystem::path& file, const ColumnLabel& label);

}  // namespace rigcal::datasets
