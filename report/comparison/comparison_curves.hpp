#pragma once

#include <string>
#include <vector>

#include "report/comparison/comparison.hpp"
#include "report/store/folder.hpp"
#include "report/store/table.hpp"

namespace rigcal::report {

/// The measured and simulated series of a condition of one result.
struct ConditionSeries {
  std::size_t result = 0;  ///< its number in the comparison, from 0
  Table series;            ///< residuals/<condition>.csv
};

/// One table of the results' curves of a condition: `time_s`; per channel that the first of them
/// has, `measured_` of the first and `simulated_` of each with its number from 1 behind the name.
/// The last two periods of a periodic drive, else all, at 800 points at most: the least and largest
/// measured value of equal stretches. A result with other sample times is read between its samples;
/// a field is empty where it has none.
///
/// @param frequency_hz  of a periodic drive; 0 for any other
Table overlaid(const std::vector<ConditionSeries>& results, double frequency_hz);

/// overlay/<condition>.csv of every condition that two or more of the results have simulated.
///
/// @throws InputError  a result's residuals are no table, or its condition has a name that cannot
///                     be that of a file
std::vector<ResultFile> comparison_curves(const std::vector<Compared>& results);

}  // namespace rigcal::report
