#pragma once

#include <filesystem>
#include <optional>

namespace rigcal {

/// Returns a file in `share/`, next to the `bin/` folder of the running program, if it exists. A
/// program that is unpacked into any folder can thus find its data.
///
/// @param path  relative to `share/`
std::optional<std::filesystem::path> installed_file(const std::filesystem::path& path);

}  // namespace rigcal
