#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"

namespace rigcal::datasets {

/// Doubt about a sensor that must be known before a result is signed.
struct SensorDoubt {
  std::string code;   ///< "sensor_overdue", "sensor_dates", "sensor_uncertainty"
  bool grave = true;  ///< false: the doubt is shown, but changes no verdict
  std::string words;
};

/// Finds doubts about the sensors of [report]: a sensor was overdue for calibration on the day of a
/// test (ISO/IEC 17025:2017, 6.4.13), was due before it was calibrated, or its uncertainty cannot
/// be read as a number. A stated uncertainty of an input channel, which affects no result, is a
/// doubt, too.
std::vector<SensorDoubt> sensor_doubts(const Campaign& campaign);

}  // namespace rigcal::datasets
