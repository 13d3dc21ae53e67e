#pragma once

#include <filesystem>
#include <optional>

namespace rigcal {

/// A file of `share/` beside the folder `bin/` of the running program, if there is one. An archive
/// that was unpacked anywhere finds its data so.
///
/// @param path  below `share/`
std::optional<std::filesystem::path> installed_file(const std::filesystem::path& path);

}  // namespace rigcal
