#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/describe.hpp"
#include "common/range.hpp"
#include "datasets/campaign/campaign.hpp"
#include "datasets/campaign/diagnosis_settings.hpp"
#include "diagnosis/table/leak_table.hpp"

// The limits of the classes, and the other settings of a diagnosis that results state.

namespace rigcal::diagnosis {

/// Settings of a diagnosis as its result states them.
struct StatedSettings {
  Keyed<double> limits_percent;  ///< upper limit of every class except the last
  double least_probability = 0.0, false_alarms = 0.0, detection = 0.0;
  /// Present if the leak is laminar. Each `leakage_coefficient` of the result is then the
  /// conductance of the leak [m3/(s Pa)].
  Omittable<datasets::LeakLaw> leak_law;
  RIGCAL_DESCRIBE(limits_percent, least_probability, false_alarms, detection, leak_law)

  bool is_laminar() const { return leak_law == datasets::LeakLaw::laminar; }
};
StatedSettings stated(const datasets::DiagnosisSettings& settings);

/// A row of a leak table that serves as a class limit.
struct ClassLimit {
  std::string signal;
  double share_percent = 0.0;
  std::optional<datasets::LeakClass> class_;  ///< this is the upper limit of the class
  std::vector<double> coefficients;
  std::vector<std::optional<Range>> coefficients_ci95;  ///< one per coefficient
  RIGCAL_DESCRIBE(signal, share_percent, class_, coefficients, coefficients_ci95)
};

/// Takes the class limits from the rows of a leak table. In increasing order they are the upper
/// limits of slight, medium and critical. A fourth row is inside supercritical and does not limit
/// any class. If there are five rows, the first is the upper limit of normal; otherwise the limit
/// of normal does not change.
///
/// @throws InputError  if there are fewer than three or more than five rows, or the first is not
///                     above the limit of normal
void take_limits(datasets::DiagnosisSettings& settings, const std::vector<double>& targets_percent,
                 const std::string& file);

/// Describes the entries of a leak table as limits of the classes, which take_limits() has set. A
/// row inside supercritical does not end a class.
std::vector<ClassLimit> class_limits(const datasets::Campaign& campaign,
                                     const std::vector<LeakEntry>& entries);

}  // namespace rigcal::diagnosis
