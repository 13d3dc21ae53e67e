#pragma once

#include <filesystem>
#include <string>

#include "datasets/draft/file_columns.hpp"

namespace rigcal::datasets {

/// Returns the text of [recording.channels]: a line for each recognised channel; blanks, with the
/// columns that may fill them, for a time, a motion and a drive that are not recognised; and the
/// other columns with their ranges, as comments.
std::string channels_text(const std::filesystem::path& file, const FileColumns& columns);

}  // namespace rigcal::datasets
