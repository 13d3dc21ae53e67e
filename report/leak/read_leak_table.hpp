#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "diagnosis/table/leak_table.hpp"
#include "report/store/validity.hpp"

namespace rigcal::report {

/// The data in leak_table.json that a diagnosis needs.
struct EarlierLeakTable {
  std::vector<diagnosis::LeakEntry> limits;  ///< each with an amplitude, and an interval, or null,
                                             ///< for each coefficient
  std::vector<double> targets_percent;       ///< values of the table rows, in increasing order
  std::vector<std::pair<int, double>> rig;   ///< row of the parameter table, and value in SI units
};

/// Reads leak_table.json and rejects anything unexpected.
///
/// @throws InputError  if a key is missing or wrong; names file and key, what was found and what
///                     was expected
EarlierLeakTable read_leak_table(const std::filesystem::path& file, model::PlantKind plant);

/// Lists, in words, how the rig of a leak table differs from the rig of a campaign with the fitted
/// values: "damping is 900 N s/m in the table, 1000 N s/m in the diagnosis". The list is empty if
/// they agree. Ignores sensors, values that are estimated for every record, and the leakage
/// coefficient, which the table varies.
std::vector<std::string> rig_differences(const EarlierLeakTable& table,
                                         const datasets::Campaign& campaign,
                                         const std::vector<datasets::FittedValue>& fitted);

}  // namespace rigcal::report
