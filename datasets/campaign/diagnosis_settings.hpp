#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>

#include "common/describe.hpp"

namespace rigcal::datasets {

/// Fault classes, defined by the leak share (leak flow over servo flow).
enum class LeakClass { normal, slight, medium, critical, supercritical };
RIGCAL_NAMES(LeakClass, normal, slight, medium, critical, supercritical)

inline constexpr std::array kLeakClasses{LeakClass::normal, LeakClass::slight, LeakClass::medium,
                                         LeakClass::critical, LeakClass::supercritical};

/// Law of the leak that a diagnosis fits: through an orifice, proportional to the root of the
/// pressure, or laminar, proportional to the pressure.
enum class LeakLaw { orifice, laminar };
RIGCAL_NAMES(LeakLaw, orifice, laminar)

/// Returns the key of the parameter that a diagnosis with this law fits.
const char* leak_parameter(LeakLaw law);

/// Settings in [diagnosis]; all are optional.
struct DiagnosisSettings {
  LeakLaw leak_law = LeakLaw::orifice;
  /// Upper limit of every class except the last, as a fraction of the servo flow. 10, 20 and 30 %
  /// are from the paper; 1 % for a machine without a leak is our choice.
  std::array<double, kLeakClasses.size() - 1> limits{0.01, 0.10, 0.20, 0.30};
  /// If no class has this probability, none is stated and the record is undecided.
  double least_probability = 0.5;
  double false_alarms = 0.01;  ///< false-alarm rate of the one-sided test for a leak
  double detection = 0.95;     ///< probability of detecting the smallest detectable leak
  /// Condition whose signal defines the leak share of a machine's state; empty: see
  /// diagnosis::machine_states().
  std::string duty;
  /// True classes of leak levels, for comparison with the diagnosis.
  std::map<std::string, LeakClass> level_class;
};

/// Returns the class for a leak share (fraction of the servo flow). A share equal to a limit
/// belongs to the higher class.
LeakClass class_of(const DiagnosisSettings& settings, double share);

}  // namespace rigcal::datasets
