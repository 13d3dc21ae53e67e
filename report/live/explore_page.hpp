#pragma once

#include <string>

#include "report/live/live_rig.hpp"
#include "report/store/provenance.hpp"

namespace rigcal::report {

/// A page that stands alone, with the rig in it: its curves follow whoever moves a value.
///
/// @param cases   at least one; a still picture shows the first
/// @param inputs  that the page rests on
/// @throws InputError  the first case cannot be simulated: with its place
/// @throws UsageError  this program was built without the module
std::string explore_page(const datasets::Campaign& campaign, const std::vector<LiveCase>& cases,
                         const std::string& command, const std::vector<InputFile>& inputs);

}  // namespace rigcal::report
