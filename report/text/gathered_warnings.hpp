#pragma once

#include <string>
#include <utility>
#include <vector>

namespace rigcal::report {

/// Lists each warning once, in order of first appearance, with the records concerned. Names all
/// records if they are few, otherwise gives their number and names the first ones.
///
/// @param warnings  pairs of a record's name and a warning about it
std::vector<std::string> gathered_by_text(
    const std::vector<std::pair<std::string, std::string>>& warnings);

}  // namespace rigcal::report
