#pragma once

#include <vector>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/verb.hpp"
#include "calib/published/leak_table.hpp"
#include "datasets/campaign/leak_table_settings.hpp"
#include "report/leak/leak_table.hpp"
#include "report/store/folder.hpp"

namespace rigcal::app {

/// A campaign and its [leak_table], both with the values of --set.
struct LeakTableInput {
  datasets::Campaign campaign;
  datasets::LeakTableSettings settings;
};

/// @throws InputError, UsageError
LeakTableInput load_leak_table(const CampaignOptions& options);

calib::LeakTableOptions leak_table_options(const CampaignOptions& options,
                                           const datasets::Campaign& campaign,
                                           const Invocation& invocation);

/// Files that leak_table_files() and the page may write.
report::PlannedFiles planned_leak_table(const datasets::LeakTableSettings& settings);

/// leak_table.csv and the other files of a table; leak_table.json comes last.
std::vector<report::ResultFile> leak_table_files(const report::LeakTableResult& result);

}  // namespace rigcal::app
