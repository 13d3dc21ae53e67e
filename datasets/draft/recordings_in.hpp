#pragma once

#include <filesystem>
#include <vector>

namespace rigcal::datasets {

/// Files as they are given, and for a folder the recordings in it, in the order of their names.
///
/// @throws InputError  a path is no file, or a folder that cannot be opened
/// @throws UsageError  a folder has no recordings
std::vector<std::filesystem::path> recordings_in(const std::vector<std::filesystem::path>& paths);

}  // namespace rigcal::datasets
