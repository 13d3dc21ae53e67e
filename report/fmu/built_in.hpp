#pragma once

#include <map>
#include <string_view>

namespace rigcal::report {

// The files that every FMU contains, built into the program.

/// Returns the sources, sorted by their path within sources/.
const std::map<std::string_view, std::string_view>& fmu_sources();

/// Returns the shared library compiled from fmu_sources().
std::string_view fmu_library();

}  // namespace rigcal::report
