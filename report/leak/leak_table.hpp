#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/leak_table_settings.hpp"
#include "diagnosis/table/leak_table.hpp"
#include "report/store/provenance.hpp"
#include "report/store/stored/stored_leak_table.hpp"
#include "report/store/table.hpp"

namespace rigcal::report {

/// Builds the contents of leak_table.json, without notes and warnings.
StoredLeakTable stored(diagnosis::LeakTable table, const datasets::Campaign& campaign,
                       const Provenance& provenance);

/// Writes leak_table.csv with one row per signal and target.
///
/// @param closed_loop  true if the amplitudes are positions, false if they are commands
std::string leak_table_csv(const diagnosis::LeakTable& table, bool closed_loop);

/// Writes features.csv with one row per published level: the printed and the computed
/// ones.
std::string features_csv(const diagnosis::LeakTable& table);

/// Returns the table of levels/<level>.csv for one period of the feature signal, with time,
/// reference, position, flows, and the residual relative to the rig without a leak.
///
/// @param healthy  series of the rig without a leak; null when writing that rig itself
Table level_table(const datasets::LeakSignal& signal, const diagnosis::PeriodicSeries& series,
                  const diagnosis::PeriodicSeries* healthy);

}  // namespace rigcal::report
