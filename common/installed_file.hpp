#pragma once

#include <filesystem>
#include <optional>

namespace rigcal {

/// Returns a file in `share/`, next to the `bin/` folder of the running program, if it exists. An
/// archive that is unpacked anywhere can thus find its data.
///
/// @param path  relative to `share/`
std::optional<std::filesystem::path> installed_file(const std::filesystem::path& path);

}  // namespace rigcal
