#pragma once

#include "diagnosis/record/leak_fit.hpp"
#include "report/store/json.hpp"
#include "report/store/stored/stored_fit.hpp"

namespace rigcal::bench {

/// Returns the rig that `diagnose` reads from the fit.json of a fit.
inline diagnosis::RigFit rig_of(const datasets::Campaign& campaign, const calib::Fit& fit) {
  report::StoredFit stored;
  stored.status = fit.status;
  stored.findings() = Inlined<calib::Findings>(fit);
  const report::EarlierFit earlier = report::earlier_fit(stored, "fit", campaign.rig.plant);
  diagnosis::RigFit rig{earlier.values, earlier.indices, earlier.covariance};
  if (earlier.joint) rig.consider(*earlier.joint, campaign.diagnosis.leak_law);
  return rig;
}

}  // namespace rigcal::bench
