#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"

namespace rigcal::datasets {

/// A doubt about a sensor that must be known before a result is signed.
struct SensorDoubt {
  std::string code;   ///< "sensor_overdue", "sensor_dates", "sensor_uncertainty"
  bool grave = true;  ///< false: it is shown, but changes no verdict
  std::string words;
};

/// Finds doubts about the sensors in [report]: a sensor was overdue for calibration on the day of a
/// test (ISO/IEC 17025:2017, 6.4.13), was due before it was calibrated, or has an uncertainty that
/// cannot be read as a number. An uncertainty stated for an input channel is a doubt, too, because
/// it affects no result.
std::vector<SensorDoubt> sensor_doubts(const Campaign& campaign);

}  // namespace rigcal::datasets
