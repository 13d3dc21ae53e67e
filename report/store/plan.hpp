#pragma once

#include "calib/trust/plan.hpp"
#include "report/store/stored/stored_plan.hpp"

namespace rigcal::report {

StoredPlan stored(const datasets::Campaign& campaign, const calib::Plan& plan,
                  const Provenance& provenance);

}  // namespace rigcal::report
