#pragma once

#include <filesystem>

namespace rigcal::datasets {

/// Whether a path is inside a folder once all links are resolved.
bool lies_within(const std::filesystem::path& folder, const std::filesystem::path& path);

/// Refuses a path outside the folder given with `--root`.
///
/// @param root  empty: everything may be read
/// @throws InputError  if the path is outside (names both), or the root does not exist
void require_within(const std::filesystem::path& root, const std::filesystem::path& path);

}  // namespace rigcal::datasets
