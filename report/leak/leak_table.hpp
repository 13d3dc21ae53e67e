#pragma once

#include <string>
#include <vector>

#include "calib/published/leak_table.hpp"
#include "datasets/campaign/leak_table_settings.hpp"
#include "report/store/provenance.hpp"
#include "report/store/stored/stored_leak_table.hpp"

namespace rigcal::report {

inline constexpr double kLitrePerMinute = 1e-3 / 60.0;  ///< [m3/s]

/// A leak table with all that its files are made from. Borrows everything.
struct LeakTableResult {
  const datasets::Campaign& campaign;
  const datasets::LeakTableSettings& settings;
  const calib::LeakTable& table;
  const Provenance& provenance;
  std::vector<std::string> notes = {};     ///< which values come from a fit, in words
  std::vector<std::string> warnings = {};  ///< doubts about the values
};

/// leak_table.json.
StoredLeakTable stored(const LeakTableResult& result);

/// leak_table.csv: one row per signal and target.
std::string leak_table_csv(const LeakTableResult& result);

/// features.csv: one row per published level, printed beside computed numbers.
std::string features_csv(const LeakTableResult& result);

/// levels/<level>.csv: one period of the feature signal: time, reference, position, flows, and the
/// residual against the rig without a leak.
///
/// @param healthy  null for the rig without a leak itself
std::string level_csv(const datasets::LeakSignal& signal, const calib::PeriodicSeries& series,
                      const calib::PeriodicSeries* healthy);

}  // namespace rigcal::report
