#pragma once

#include <string>

#include "calib/trust/plan.hpp"
#include "report/json/described.hpp"
#include "report/store/described_campaign.hpp"
#include "report/store/stored/stored_design.hpp"
#include "report/store/stored/stored_provenance.hpp"

// plan.json (docs/command-line.md).

namespace rigcal::report {

inline constexpr const char* kPlanSchema = "rigcal.plan/1";

struct StoredPlan : calib::Plan {
  std::string schema = kPlanSchema;
  std::string campaign;
  Omittable<StoredDesign> design;  ///< result of `plan --design`
  StoredProvenance provenance;
  RIGCAL_DESCRIBE(schema, campaign, parameters, records, messages, design, provenance)
};

}  // namespace rigcal::report
