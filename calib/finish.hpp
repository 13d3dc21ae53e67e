#pragma once

#include <vector>

#include "calib/result/fit_result.hpp"
#include "calib/result/origin.hpp"
#include "calib/search/budget.hpp"
#include "datasets/record.hpp"

namespace rigcal::calib {

/// Sorts the scores into campaign order and assesses them together.
///
/// @param origin  the earlier fit that the values come from, or null
void finish(const datasets::Campaign& campaign, const std::vector<datasets::Record>& records,
            Budget::Clock::time_point began, const Origin* origin, Fit& fit);

}  // namespace rigcal::calib
