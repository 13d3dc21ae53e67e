#pragma once

#include <vector>

#include "report/comparison/comparison.hpp"
#include "report/store/folder.hpp"
#include "report/store/table.hpp"

namespace rigcal::report {

/// Measured and simulated series for one condition, from one result.
struct ConditionSeries {
  std::size_t result = 0;  ///< index of the result in the comparison, from 0
  Table series;            ///< contents of residuals/<condition>.csv
};

/// Combines the curves of all results for one condition in a single table. Its columns are `time_s`
/// and, for each channel of the first result, one `measured_` column from the first result and one
/// `simulated_` column from each result, numbered from 1. For a periodic drive only the last two
/// periods are included. The table has at most 800 points: the minimum and maximum measured value
/// in each of several equal intervals. Results with other sample times are interpolated; fields for
/// which a result has no value are empty.
///
/// @param frequency_hz  frequency of a periodic drive; 0 for any other drive
Table overlaid(const std::vector<ConditionSeries>& results, double frequency_hz);

/// Writes overlay/<condition>.csv for every condition that at least two results have simulated.
///
/// @throws InputError  if the residuals of a result are not a table, or the name of a condition
///                     cannot be used as a file name
std::vector<ResultFile> comparison_curves(const std::vector<Compared>& results);

}  // namespace rigcal::report
