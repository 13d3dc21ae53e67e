#pragma once

#include <string>
#include <vector>

#include "calib/result/fit_result.hpp"
#include "common/describe.hpp"
#include "datasets/campaign/campaign.hpp"
#include "metrics/metric_table.hpp"

namespace rigcal::calib {

/// Agreement of one channel over several conditions.
struct GroupScore {
  int conditions = 0;  ///< number of conditions with a score
  metrics::Agreement mean;
  metrics::Agreement worst;  ///< worst value of each metric
  RIGCAL_DESCRIBE(conditions, mean, worst)
};

/// Conditions with a common property.
struct Group {
  std::string by;     ///< the property: "use", "signal", "frequency", "waveform" or "leak_level"
  std::string label;  ///< its value: "fit", "sine 0.1 Hz", "0.1 Hz", "sine", "33.33 %"
  std::vector<std::string> conditions;
  Keyed<GroupScore, datasets::Channel> metrics;  ///< in the order of the channels
  RIGCAL_DESCRIBE(by, label, conditions, metrics)
};

/// Groups the scores of a result by use, signal (waveform and frequency), frequency, waveform and
/// leak level. Leak levels are in the order of the campaign. A condition that lacks a property is
/// in none of the groups for that property.
std::vector<Group> groups(const datasets::Campaign& campaign, const Fit& fit);

}  // namespace rigcal::calib
