#pragma once

#include <map>
#include <string_view>

namespace rigcal::report {

// Files of every FMU, built into the program.

/// The sources by their paths within sources/, sorted.
const std::map<std::string_view, std::string_view>& fmu_sources();

/// The shared library compiled from them.
std::string_view fmu_library();

}  // namespace rigcal::report
