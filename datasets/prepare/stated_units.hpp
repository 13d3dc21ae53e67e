#pragma once

#include <filesystem>
#include <string>

#include "datasets/campaign/campaign.hpp"
#include "datasets/read/record_table.hpp"

namespace rigcal::datasets {

/// Holds the unit that a file names for a column against that of the campaign: in brackets or
/// behind an underscore of its name, in a row of units, in an attribute. They are compared by
/// meaning, to 1e-6. A gain that converts from the file's unit, within 5 %, contradicts nothing;
/// nor does one to a unit of another dimension. What is no unit, or only looks like one of another
/// dimension
/// ("p_in" in bar), is passed over.
///
/// @param key  of the channel in the campaign file: "position"
/// @throws InputError  the two contradict each other: names both, with file, place and key
void require_stated_unit(const StatedUnit& stated, const std::string& key,
                         const std::filesystem::path& file, const ColumnLabel& label);

}  // namespace rigcal::datasets
