#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>

namespace rigcal::datasets {

/// Fault classes by the share of the servo flow that leaks.
enum class LeakClass { normal, slight, medium, critical, supercritical };

inline constexpr std::array kLeakClasses{LeakClass::normal, LeakClass::slight, LeakClass::medium,
                                         LeakClass::critical, LeakClass::supercritical};
std::string_view to_string(LeakClass leak_class);

/// [diagnosis], all optional.
struct DiagnosisSettings {
  /// Upper limit of every class but the last, as a fraction of the servo flow. Source: the paper
  /// for 10, 20 and 30 %; 1 % for a machine without a leak is a choice.
  std::array<double, kLeakClasses.size() - 1> limits{0.01, 0.10, 0.20, 0.30};
  /// A class of lower probability is not stated: the record is undecided.
  double least_probability = 0.5;
  double false_alarms = 0.01;  ///< rate of the one-sided test for a leak
  double detection = 0.95;     ///< fraction of leaks of the smallest detectable size that are found
  /// Condition at whose signal the share of a machine's state is stated; empty: see
  /// diagnosis::machine_states().
  std::string duty;
  /// Leak levels of known class, by which the diagnosis is judged.
  std::map<std::string, LeakClass> level_class;
};

/// Class of a share (fraction of the servo flow); a share at a limit is above it.
LeakClass class_of(const DiagnosisSettings& settings, double share);

}  // namespace rigcal::datasets
