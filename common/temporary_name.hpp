#pragma once

#include <filesystem>

namespace rigcal {

/// ".NAME.PROCESS.NUMBER.tmp" beside a file, for what is not to stay. Process and running number
/// keep writers of the same file apart.
std::filesystem::path temporary_name(const std::filesystem::path& target);

}  // namespace rigcal
