#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/result/fit_result.hpp"
#include "calib/search/fit_options.hpp"

namespace rigcal::calib {

/// Information in one existing or planned record.
struct PlannedRecord {
  std::string condition;
  bool recorded = false;                       ///< false: planned, only simulated
  std::string problem;                         ///< why nothing is known; otherwise empty
  std::vector<std::optional<double>> alone;    ///< sd of each unknown from this record only, SI;
                                               ///< shape (unknowns), even if nothing is known
  std::vector<std::optional<double>> without;  ///< sd from all records except this one; same shape
};

/// Cramer-Rao standard deviations at given values, for white noise, a correct model and all
/// unknowns free. A real fit is less precise.
struct Plan {
  std::vector<FittedParameter> parameters;      ///< value and bounds of each unknown, no errors
  std::vector<std::optional<double>> recorded;  ///< sd from all existing records
  std::vector<std::optional<double>> all;       ///< sd with the planned records included
  std::vector<PlannedRecord> records;
  std::vector<std::string> remedies;  ///< for each unknown, what would determine it; may be empty
  std::vector<std::string> messages;  ///< determined combinations, symmetries, suggested additions
};

/// Plans records. A condition with use `fit` or `validate` counts as planned if it has no record
/// but has duration and sample rate. Its noise is the `sd` of the channel, or that of [synthetic]
/// divided by the root of the number of repeats, or that of the existing records. With
/// `planned_repeats` it is the noise of a single repeat divided by the root of that number.
///
/// @param values  values from an earlier fit, or null for those of the campaign
/// @throws InputError  if nothing is free, there is no condition, or the noise of a planned
///                     condition is unknown
Plan plan(const datasets::Campaign& campaign, const std::vector<datasets::Record>& records,
          const std::vector<datasets::FittedValue>* values, int threads);

}  // namespace rigcal::calib
