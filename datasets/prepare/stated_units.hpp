#pragma once

#include <filesystem>
#include <string>

#include "datasets/campaign/campaign.hpp"
#include "datasets/read/record_table.hpp"

namespace rigcal::datasets {

/// Compares the unit that a file gives for a column with the unit stated in the campaign. A file
/// gives units in the name of the column (in brackets or after an underscore), in a row of units,
/// or in an attribute. Two units are equal if they convert with a factor of 1 within 1e-6. There is
/// no contradiction if the stated gain performs the conversion within 5 %, or if it relates units
/// of different dimensions. Texts that are not units are ignored, and so are names that only look
/// like a unit of another dimension ("p_in" in bar).
///
/// @param key  channel in the campaign file: "position"
/// @throws InputError  if the units contradict each other; the message names both, with file, place
///                     and key
void require_stated_unit(const StatedUnit& stated, const std::string& key,
                         const std::filesystem::path& file, const ColumnLabel& label);

}  // namespace rigcal::datasets
