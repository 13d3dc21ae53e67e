#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"

namespace rigcal::datasets {

/// What is to be known of a sensor before a result that rests on it is signed.
struct SensorDoubt {
  std::string code;   ///< "sensor_overdue", "sensor_dates", "sensor_uncertainty"
  bool grave = true;  ///< else it is told, and changes nothing
  std::string words;
};

/// Sensors of [report] that were past their due date on the day of a test (ISO/IEC 17025:2017,
/// 6.4.13), or due before they were calibrated, or whose uncertainty is a text that cannot count;
/// and uncertainties of channels that are in no figure.
std::vector<SensorDoubt> sensor_doubts(const Campaign& campaign);

}  // namespace rigcal::datasets
