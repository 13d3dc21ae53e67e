#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "report/json/json_fields.hpp"
#include "report/run/simulation.hpp"

// What the script of a live page needs of a rig, to simulate it as `rigcal simulate` does.

namespace rigcal::report {

/// A drive with which a page may begin, and the rig as it is there.
struct LiveCase {
  std::string name;  ///< for people: the condition's id, or that of a signal of the leak table
  datasets::Condition condition;  ///< with duration and sample rate where its drive is made
  SimulationTask task;
};

/// The signals of a [leak_table] with the values that it assumes, then every condition that is not
/// ignored and whose rig is known.
///
/// @throws InputError  none can be simulated, or a recording cannot be read: with its place
std::vector<LiveCase> live_cases(const datasets::Campaign& campaign);

/// The rig as data of the script: parameters with units and ranges, cases, leak levels, classes.
///
/// @param cases  at least one
Json live_rig(const datasets::Campaign& campaign, const std::vector<LiveCase>& cases);

}  // namespace rigcal::report
