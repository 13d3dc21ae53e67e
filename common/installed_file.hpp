#pragma once

#include <filesystem>
#include <optional>

namespace rigcal {

/// A file of `share/` beside the folder `bin/` that the running program lies in, if there is one:
/// what an archive that was unpacked anywhere finds its data by.
///
/// @param path  below `share/`
std::optional<std::filesystem::path> installed_file(const std::filesystem::path& path);

}  // namespace rigcal
