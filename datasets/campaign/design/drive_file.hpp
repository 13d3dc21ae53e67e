#pragma once

#include <string>
#include <vector>

#include "common/quantity.hpp"
#include "datasets/campaign/campaign.hpp"

namespace rigcal::datasets {

/// Unit of the drive in the file for the controller.
struct DriveUnit {
  std::string name;      ///< unit of the drive's channel in the campaign, otherwise its SI unit
  UnitConversion to_si;  ///< does not include the gain of the recording
};
DriveUnit drive_unit(const Campaign& campaign);

/// Writes the drive of a designed test as CSV for the controller. The columns are time_s and the
/// drive, whose name includes its unit, such as reference_mm. Numbers have ten digits.
std::string drive_csv(const Campaign& campaign, const std::vector<double>& time_s,
                      const std::vector<double>& drive_si);

/// Returns a value of the drive, SI, after the rounding in drive_csv().
double written_drive(const DriveUnit& unit, double value_si);

/// Returns the id of the condition for a designed test.
std::string designed_condition_id(DriveFamily family);

}  // namespace rigcal::datasets
