#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace rigcal {

/// Writes `content` beside `path` and renames it into place, so that a reader sees the old file or
/// the whole new one. Creates missing folders.
///
/// @throws WriteError  with path and reason; no partial file stays behind
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

/// SHA-256 of a file, 64 lower-case hex digits. Reads in blocks.
///
/// @throws InputError  the file cannot be read
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace rigcal
