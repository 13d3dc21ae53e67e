#pragma once

#include <filesystem>

namespace rigcal::datasets {

/// Whether a path leads into a folder, wherever links lead.
bool lies_within(const std::filesystem::path& folder, const std::filesystem::path& path);

/// Refuses what leads out of the folder that `--root` names.
///
/// @param root  empty: everything may be read
/// @throws InputError  names both; there is no such root
void require_within(const std::filesystem::path& root, const std::filesystem::path& path);

}  // namespace rigcal::datasets
