#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace rigcal {

/// Name of a temporary file next to its target: ".NAME.PROCESS.NUMBER.tmp". The process ID and a
/// counter distinguish writers of the same file.
std::filesystem::path temporary_name(const std::filesystem::path& target);

/// Removes the temporary files for `names` that killed processes left in a folder. Files of other
/// running processes are kept. Files with the ID of this process are removed, so call this before
/// writing.
void remove_left_behind(const std::filesystem::path& folder, const std::set<std::string>& names);

}  // namespace rigcal
