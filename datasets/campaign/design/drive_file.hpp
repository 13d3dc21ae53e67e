#pragma once

#include <string>
#include <vector>

#include "common/quantity.hpp"
#include "datasets/campaign/campaign.hpp"

namespace rigcal::datasets {

/// The unit in which the controller gets a drive.
struct DriveUnit {
  std::string name;      ///< that of the drive's channel in the campaign, else its SI unit
  UnitConversion to_si;  ///< without the gain of the recording
};
DriveUnit drive_unit(const Campaign& campaign);

/// The drive of a designed test as CSV for the controller: time_s, and the drive with its unit,
/// such as reference_mm. Numbers have ten digits.
std::string drive_csv(const Campaign& campaign, const std::vector<double>& time_s,
                      const std::vector<double>& drive_si);

/// A value of the drive as drive_csv() writes it and a controller reads it, SI.
double written_drive(const DriveUnit& unit, double value_si);

/// Name of the condition of a designed test.
std::string designed_condition_id(DriveFamily family);

}  // namespace rigcal::datasets
