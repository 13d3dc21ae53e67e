#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/leak_table_settings.hpp"
#include "diagnosis/table/leak_table.hpp"
#include "report/store/provenance.hpp"
#include "report/store/stored/stored_leak_table.hpp"
#include "report/store/table.hpp"

namespace rigcal::report {

/// A leak table with everything needed to write its files. Borrows all of it.
struct LeakTableResult {
  const datasets::Campaign& campaign;
  const datasets::LeakTableSettings& settings;
  const diagnosis::LeakTable& table;
  const Provenance& provenance;
  std::vector<std::string> notes = {};     ///< which values come from a fit, in words
  std::vector<std::string> warnings = {};  ///< doubts about the values
};

/// Builds the contents of leak_table.json.
StoredLeakTable stored(const LeakTableResult& result);

/// Writes leak_table.csv with one row per signal and target.
std::string leak_table_csv(const LeakTableResult& result);

/// Writes features.csv with one row per published level: the printed and the computed
/// ones.
std::string features_csv(const LeakTableResult& result);

/// Returns the table of levels/<level>.csv for one period of the feature signal, with time,
/// reference, position, flows, and the residual relative to the rig without a leak.
///
/// @param healthy  series of the rig without a leak; null when writing that rig itself
Table level_table(const datasets::LeakSignal& signal, const diagnosis::PeriodicSeries& series,
                  const diagnosis::PeriodicSeries* healthy);

}  // namespace rigcal::report
