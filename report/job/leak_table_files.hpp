#pragma once

#include <atomic>
#include <vector>

#include "datasets/campaign/leak_table_settings.hpp"
#include "diagnosis/table/leak_table.hpp"
#include "report/leak/leak_table.hpp"
#include "report/run/campaign_choice.hpp"
#include "report/store/folder.hpp"

namespace rigcal::report {

/// A campaign and its [leak_table], both with the values from --set.
struct LeakTableInput {
  datasets::Campaign campaign;
  datasets::LeakTableSettings settings;
};

/// Loads a campaign and its [leak_table], and applies --set.
///
/// @throws InputError, UsageError  if the campaign, its [leak_table] or a --set is invalid
LeakTableInput load_leak_table(const CampaignChoice& choice);

/// @param cancel  set to true to stop the computation; borrowed
diagnosis::LeakTableOptions leak_table_options(const datasets::Campaign& campaign, int threads,
                                               const std::atomic<bool>& cancel);

/// Lists the files that leak_table_files() and the page may write.
PlannedFiles planned_leak_table(const datasets::LeakTableSettings& settings);

/// Writes leak_table.csv and the other files of a leak table. leak_table.json comes last.
std::vector<ResultFile> leak_table_files(const datasets::Campaign& campaign,
                                         const datasets::LeakTableSettings& settings,
                                         StoredLeakTable table);

}  // namespace rigcal::report
