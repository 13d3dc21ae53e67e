#pragma once

#include <filesystem>
#include <vector>

namespace rigcal::datasets {

/// Returns the files among the paths and, for each folder, the recordings in it, sorted by name.
///
/// @throws InputError  if a path is not a file, or a folder cannot be opened
/// @throws UsageError  if a folder contains no recordings
std::vector<std::filesystem::path> recordings_in(const std::vector<std::filesystem::path>& paths);

}  // namespace rigcal::datasets
