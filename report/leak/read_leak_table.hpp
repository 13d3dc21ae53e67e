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
  std::vector<std::optional<Range>> ranges_95;  ///< of each
};

/// What a diagnosis needs of leak_table.json.
struct EarlierLeakTable {
  std::vector<TableLimit> limits;
  std::vector<double> targets_percent;      ///< rows, increasing
  std::vector<std::pair<int, double>> rig;  ///< row of the parameter table, value in SI
};

/// Reads leak_table.json strictly.
///
/// @throws InputError  file and key, what was found and what was expected
EarlierLeakTable read_leak_table(const std::filesystem::path& file, model::PlantKind plant);

/// Where the rig of a table is another than that of a campaign with the values of a fit, in words:
/// "damping is 900 N s/m in the table, 1000 N s/m in the diagnosis"; empty where they agree. The
/// leakage coefficient is what a table varies; sensors and what is estimated for every record do
/// not count.
std::vector<std::string> rig_differences(const EarlierLeakTable& table,
                                         const datasets::Campaign& campaign,
                                         const std::vector<datasets::FittedValue>& fitted);

/// The limits of the classes by the rows of a table, in increasing order the upper limits of
/// slight, medium and critical; a fourth row lies within supercritical and limits nothing. Of five
/// the first is that of normal, which otherwise stays as it is.
///
/// @throws InputError  fewer rows than three or more than five, or the first is not above the limit
///                     of normal
void take_limits(datasets::DiagnosisSettings& settings, const std::vector<double>& targets_percent,
                 const std::string& file);

/// The class that ends at a row by take_limits(): empty for one that limits nothing.
std::optional<datasets::LeakClass> class_ending_at(const datasets::DiagnosisSettings& settings,
                                                   double target_percent);

}  // namespace rigcal::report
