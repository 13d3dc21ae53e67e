#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/campaign/diagnosis_settings.hpp"
#include "report/store/validity.hpp"

namespace rigcal::report {

/// An entry of a leak table as limit of a class.
struct TableLimit {
  datasets::Waveform waveform = datasets::Waveform::sine;
  double frequency_hz = 0.0;
  double amplitude = 0.0;  ///< [m], or [V] where no controller is in the loop
  double target_percent = 0.0;
  std::vector<double> coefficients;             ///< all roots, increasing
  std::vector<std::optional<Range>> ranges_95;  ///< intervals of each
};

/// Data of leak_table.json for a diagnosis.
struct EarlierLeakTable {
  std::vector<TableLimit> limits;
  std::vector<double> targets_percent;      ///< rows, increasing
  std::vector<std::pair<int, double>> rig;  ///< row of the parameter table, value in SI
};

/// Reads leak_table.json strictly.
///
/// @throws InputError  file and key, what was found and what was expected
EarlierLeakTable read_leak_table(const std::filesystem::path& file, model::PlantKind plant);

/// Lists, in words, the differences between the rig of a table and that of a campaign with the
/// values of a fit: "damping is 900 N s/m in the table, 1000 N s/m in the diagnosis"; empty if they
/// agree. The leakage coefficient, which a table varies, sensors, and values that are estimated for
/// every record are ignored.
std::vector<std::string> rig_differences(const EarlierLeakTable& table,
                                         const datasets::Campaign& campaign,
                                         const std::vector<datasets::FittedValue>& fitted);

/// Takes the limits of the classes from the rows of a table: in increasing order the upper limits
/// of slight, medium and critical. A fourth row is within supercritical and limits nothing. With
/// five rows the first one is the limit of normal, which otherwise stays.
///
/// @throws InputError  fewer than three or more than five rows, or the first is not above the limit
///                     of normal
void take_limits(datasets::DiagnosisSettings& settings, const std::vector<double>& targets_percent,
                 const std::string& file);

/// The class that ends at a row by take_limits(); empty if the row limits nothing.
std::optional<datasets::LeakClass> class_ending_at(const datasets::DiagnosisSettings& settings,
                                                   double target_percent);

}  // namespace rigcal::report
