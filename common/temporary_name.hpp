#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace rigcal {

/// ".NAME.PROCESS.NUMBER.tmp" beside a file, for what is not to stay. Process and running number
/// keep writers of the same file apart.
std::filesystem::path temporary_name(const std::filesystem::path& target);

/// Removes what killed processes have left in a folder by such names of `names`. What another
/// process writes that lives stays. Of this one what is there counts as left: it has not begun yet.
void remove_left_behind(const std::filesystem::path& folder, const std::set<std::string>& names);

}  // namespace rigcal
