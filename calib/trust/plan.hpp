#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/trust/information.hpp"
#include "common/describe.hpp"

namespace rigcal::calib {

/// Information in one record, existing or planned.
struct PlannedRecord {
  std::string condition;
  bool recorded = false;               ///< false: planned, simulated only
  std::optional<std::string> problem;  ///< why nothing is known of it
  /// Standard deviation of each unknown from this record alone, SI; shape (unknowns), also if
  /// nothing is known.
  std::vector<std::optional<double>> sd_alone;
  std::vector<std::optional<double>> sd_without;  ///< likewise, from all other records
  RIGCAL_DESCRIBE(condition, recorded, problem, sd_alone, sd_without)
};

/// One unknown, with its standard deviations, SI; absent where it is not determined.
struct PlannedParameter : TestedParameter {
  bool nuisance = false;
  std::optional<double> sd_recorded;  ///< from all records that exist
  std::optional<double> sd_all;       ///< and with the planned ones
  std::optional<std::string> remedy;  ///< what would determine it
  RIGCAL_DESCRIBE(name, unit, scope, level, nuisance, value, sd_recorded, sd_all, remedy)
};

/// Cramer-Rao standard deviations at given values: white noise, a correct model, every unknown
/// free. A real fit is less precise.
struct Plan {
  std::vector<PlannedParameter> parameters;
  std::vector<PlannedRecord> records;
  std::vector<std::string> messages;  ///< determined combinations, symmetries, suggested additions
};

/// Conditions of use `fit` or `validate` without a record, but with duration and sample rate, are
/// planned ones. Their noise is the channel's `sd`, that of [synthetic] divided by the root of its
/// repeats, or that of the records; with `planned_repeats` that of a single repeat divided by its
/// root.
///
/// @param values  of an earlier fit, or null: the campaign's own
/// @throws InputError  nothing is free, no condition, or a planned one of unknown noise
Plan plan(const datasets::Campaign& campaign, const std::vector<datasets::Record>& records,
          const std::vector<datasets::FittedValue>* values, int threads);

}  // namespace rigcal::calib
