#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/problem/simulation_task.hpp"
#include "datasets/campaign/campaign.hpp"
#include "datasets/campaign/leak_table_settings.hpp"
#include "report/json/json_fields.hpp"

// Data that the script of a live page needs to simulate a rig like `rigcal simulate`.

namespace rigcal::report {

/// A drive that a page offers, with the state of the rig for it.
struct LiveCase {
  std::string name;               ///< the condition's id, or the name of a signal of the leak table
  datasets::Condition condition;  ///< with duration and rate if its drive is generated
  calib::SimulationTask task;
};

/// Lists the signals of a [leak_table] with its assumed values, then every condition that is not
/// ignored and whose rig is known.
///
/// @param fitted  estimates in place of the campaign's values; then without the leak table, whose
/// values
///                are assumed
/// @throws InputError  no case can be simulated, or a recording cannot be read (names its place)
std::vector<LiveCase> live_cases(const datasets::Campaign& campaign,
                                 const std::vector<datasets::FittedValue>& fitted = {});

/// The signals of a leak table, that of its features first, with the smallest leak of these.
std::vector<LiveCase> leak_table_cases(const datasets::Campaign& campaign,
                                       const datasets::LeakTableSettings& settings);

/// Data of the rig for the script: parameters with units and ranges, cases, leak levels, classes.
///
/// @param cases  at least one
Json live_rig(const datasets::Campaign& campaign, const std::vector<LiveCase>& cases);

/// List of [index, SI value] of the given parameters.
Json given_values(const model::ParameterValues& values);

/// Makes a case of a condition with these values.
///
/// @param record  if given, the case has its samples
LiveCase live_case(const datasets::Campaign& campaign, std::string name,
                   datasets::Condition condition, model::ParameterValues values,
                   std::optional<datasets::Record> record = std::nullopt);

}  // namespace rigcal::report
