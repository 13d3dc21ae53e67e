#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/problem/simulation_task.hpp"
#include "datasets/campaign/campaign.hpp"
#include "datasets/campaign/leak_table_settings.hpp"
#include "report/json/json_fields.hpp"

// Data that the script of a live page needs to simulate a rig in the same way as `rigcal simulate`.

namespace rigcal::report {

/// A drive that a page offers, with the state of the rig for it.
struct LiveCase {
  std::string name;               ///< id of the condition, or name of a signal in the leak table
  datasets::Condition condition;  ///< includes duration and sample rate if the drive is generated
  calib::SimulationTask task;
};

/// Lists the signals of a [leak_table] with its assumed values, then every condition that is not
/// ignored and whose rig is known.
///
/// @param fitted  estimates that replace the campaign's values. The leak table is then left out,
///                because its values are assumed.
/// @throws InputError  if no case can be simulated or a recording cannot be read; names its place
std::vector<LiveCase> live_cases(const datasets::Campaign& campaign,
                                 const std::vector<datasets::FittedValue>& fitted = {});

/// Lists the signals of a leak table, starting with the feature signal, at the smallest published
/// leak.
std::vector<LiveCase> leak_table_cases(const datasets::Campaign& campaign,
                                       const datasets::LeakTableSettings& settings);

/// Returns the data of the rig for the script: parameters with units and ranges, cases, leak
/// levels, classes.
///
/// @param cases  at least one
Json live_rig(const datasets::Campaign& campaign, const std::vector<LiveCase>& cases);

/// Lists the parameters that have a value, as pairs [index, SI value].
Json given_values(const model::ParameterValues& values);

/// Makes a case from a condition and parameter values.
///
/// @param record  if present, the case has the samples of this record
LiveCase live_case(const datasets::Campaign& campaign, std::string name,
                   datasets::Condition condition, model::ParameterValues values,
                   std::optional<datasets::Record> record = std::nullopt);

}  // namespace rigcal::report
