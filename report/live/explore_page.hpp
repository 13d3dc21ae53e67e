#pragma once

#include <string>

#include "report/live/live_rig.hpp"
#include "report/store/provenance.hpp"

namespace rigcal::report {

/// Makes a self-contained page that simulates the rig. Its curves follow every change of a value.
///
/// @param cases   at least one; a still picture shows the first
/// @param inputs  files that the page is made from
/// @throws InputError  if the first case cannot be simulated; names its place
/// @throws UsageError  if this program was built without the module
std::string explore_page(const datasets::Campaign& campaign, const std::vector<LiveCase>& cases,
                         const std::string& command, const std::vector<InputFile>& inputs);

}  // namespace rigcal::report
