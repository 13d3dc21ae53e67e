#pragma once

#include <vector>

#include "calib/result/fit_result.hpp"
#include "calib/result/origin.hpp"
#include "calib/search/budget.hpp"
#include "datasets/record.hpp"

namespace rigcal::calib {

/// Puts scores in the order of the campaign and judges them together.
///
/// @param origin  of the values where they are an earlier fit's
void finish(const datasets::Campaign& campaign, const std::vector<datasets::Record>& records,
            Budget::Clock::time_point began, const Origin* origin, Fit& fit);

}  // namespace rigcal::calib
