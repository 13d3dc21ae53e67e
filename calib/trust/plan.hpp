#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/result/fit_result.hpp"
#include "calib/search/fit_options.hpp"

namespace rigcal::calib {

/// Information in one record, existing or planned.
struct PlannedRecord {
  std::string condition;
  bool recorded = false;                       ///< false: planned, simulated only
  std::string problem;                         ///< why nothing is known of it; else empty
  std::vector<std::optional<double>> alone;    ///< sd of each unknown from this record alone, SI;
                                               ///< shape (unknowns), also if nothing is known
  std::vector<std::optional<double>> without;  ///< and from all records but this; the same shape
};

/// Cramer-Rao standard deviations at given values: white noise, a correct model, every unknown
/// free. A real fit is less precise.
struct Plan {
  std::vector<FittedParameter> parameters;      ///< value and bounds of each unknown, no errors
  std::vector<std::optional<double>> recorded;  ///< sd from all records that exist
  std::vector<std::optional<double>> all;       ///< and with the planned ones
  std::vector<PlannedRecord> records;
  std::vector<std::string> remedies;  ///< per unknown: what would determine it; may be empty
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
