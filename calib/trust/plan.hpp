#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/trust/information.hpp"
#include "common/describe.hpp"

namespace rigcal::calib {

/// The information that one existing or planned record contains.
struct PlannedRecord {
  std::string condition;
  bool recorded = false;               ///< false if the record is only planned, and simulated
  std::optional<std::string> problem;  ///< why the information is unknown
  /// Standard deviation of each unknown if only this record is used, SI. Shape (unknowns), even if
  /// the information is unknown.
  std::vector<std::optional<double>> sd_alone;
  /// From all records except this one, SI; shape (unknowns).
  std::vector<std::optional<double>> sd_without;
  RIGCAL_DESCRIBE(condition, recorded, problem, sd_alone, sd_without)
};

/// One unknown with its standard deviations, SI, which are absent if the records do not determine
/// it.
struct PlannedParameter : TestedParameter {
  bool nuisance = false;
  std::optional<double> sd_recorded;  ///< standard deviation from all existing records
  std::optional<double> sd_all;       ///< standard deviation from all existing and planned records
  std::optional<std::string> remedy;  ///< an addition that would determine the unknown
  RIGCAL_DESCRIBE(name, unit, scope, level, nuisance, value, sd_recorded, sd_all, remedy)
};

/// Cramer-Rao standard deviations at given values, assuming white noise, a correct model, and that
/// all unknowns are free. A real fit is less precise.
struct Plan {
  std::vector<PlannedParameter> parameters;
  std::vector<PlannedRecord> records;
  /// Determined combinations, symmetries and suggested additions.
  std::vector<std::string> messages;
};

/// Plans records. A condition with use `fit` or `validate` counts as planned if it has no record
/// but has duration and sample rate. Its noise is given by planned_sd().
///
/// @param values  values from an earlier fit, or null for those of the campaign
/// @throws InputError  if no parameter is free, there is no condition, or the noise of a planned
///                     condition is unknown
Plan plan(const datasets::Campaign& campaign, const std::vector<datasets::Record>& records,
          const std::vector<datasets::FittedValue>* values, int threads);

}  // namespace rigcal::calib
