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
  int conditions = 0;  ///< number of those with a score
  metrics::Agreement mean;
  metrics::Agreement worst;  ///< metric by metric
  RIGCAL_DESCRIBE(conditions, mean, worst)
};

/// Conditions that have something in common.
struct Group {
  std::string by;     ///< "use", "signal", "frequency", "waveform", "leak_level"
  std::string label;  ///< "fit", "sine 0.1 Hz", "0.1 Hz", "sine", "33.33 %"
  std::vector<std::string> conditions;
  Keyed<GroupScore, datasets::Channel> metrics;  ///< in the order of the channels
  RIGCAL_DESCRIBE(by, label, conditions, metrics)
};

/// The scores of a result gathered by use, signal (waveform and frequency), frequency, waveform and
/// leak level (in the order of the campaign). A condition that lacks the property is in no such
/// group.
std::vector<Group> groups(const datasets::Campaign& campaign, const Fit& fit);

}  // namespace rigcal::calib
