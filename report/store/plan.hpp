#pragma once

#include "calib/design/design.hpp"
#include "calib/trust/plan.hpp"
#include "report/store/stored/stored_plan.hpp"
#include "report/store/table.hpp"

namespace rigcal::report {

StoredPlan stored(const datasets::Campaign& campaign, const calib::Plan& plan,
                  const Provenance& provenance);

StoredDesign stored(const datasets::Campaign& campaign, const calib::Design& design);

/// The predicted response to a designed drive, a row for each of its samples, SI.
Table response_of(const datasets::Campaign& campaign, const calib::Design& design);

}  // namespace rigcal::report
