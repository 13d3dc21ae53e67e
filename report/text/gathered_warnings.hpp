#pragma once

#include <string>
#include <utility>
#include <vector>

namespace rigcal::report {

/// Each warning once, in the order of its first appearance, with its records: their names if they
/// are few, else their number and the first ones.
///
/// @param warnings  name of a record, and a warning about it
std::vector<std::string> gathered_by_text(
    const std::vector<std::pair<std::string, std::string>>& warnings);

}  // namespace rigcal::report
