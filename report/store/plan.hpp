#pragma once

#include <string>

#include "calib/trust/plan.hpp"
#include "report/store/stored/stored_plan.hpp"

namespace rigcal::report {

StoredPlan stored(const datasets::Campaign& campaign, const calib::Plan& plan,
                  const Provenance& provenance);

/// Table of relative standard deviations per record, and of missing information, for the terminal.
///
/// @param columns  of the terminal; 0: no limit
std::string plan_text(const datasets::Campaign& campaign, const calib::Plan& plan,
                      std::size_t columns);

}  // namespace rigcal::report
