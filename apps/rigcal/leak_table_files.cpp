#include "apps/rigcal/leak_table_files.hpp"

#include <algorithm>

#include "report/store/result_files.hpp"
#include "report/store/stored.hpp"

namespace rigcal::app {
namespace {

constexpr std::string_view kResidualScale = "residual_scale=";

const std::filesystem::path kLevels = "levels";
const std::filesystem::path kHealthySeries = kLevels / "healthy.csv";

}  // namespace

LeakTableInput load_leak_table(const CampaignOptions& options) {
  CampaignOptions of_campaign = options;
  // The residual's scale is no parameter of the rig: only the leak table knows it.
  std::erase_if(of_campaign.set,
                [](const std::string& text) { return text.starts_with(kResidualScale); });
  of_campaign.free.clear();  // the tables have their own, not the records'
  LeakTableInput input{load(of_campaign), {}};
  input.settings = leak_table_settings(input.campaign);
  for (const std::string& assignment : options.set) {
    override_assumption(input.settings, input.campaign, assignment);
  }
  if (!options.free.empty()) free_assumptions(input.settings, input.campaign, options.free);
  return input;
}

calib::LeakTableOptions leak_table_options(const CampaignOptions& options,
                                           const datasets::Campaign& campaign,
                                           const Invocation& invocation) {
  calib::LeakTableOptions result;
  model::SimulationOptions& simulation = result.periodic.simulation;
  simulation.method = campaign.simulation.method;
  simulation.tolerance = campaign.simulation.tolerance.value_or(simulation.tolerance);
  simulation.max_seconds = campaign.simulation.max_seconds;
  simulation.cancel = &invocation.cancel;
  result.threads = options.threads;
  return result;
}

report::PlannedFiles planned_leak_table(const datasets::LeakTableSettings& settings) {
  report::PlannedFiles planned{
      {"leak_table.json", "leak_table.csv", "features.csv", "report.html", kHealthySeries},
      {kLevels}};
  for (const datasets::PrintedFeatures& features : settings.features)
    planned.files.push_back(kLevels / report::level_file(features.level));
  return planned;
}

std::vector<report::ResultFile> leak_table_files(const report::LeakTableResult& result) {
  const calib::LeakTable& table = result.table;
  std::vector<report::ResultFile> files;
  files.push_back({"leak_table.csv", report::leak_table_csv(result)});
  if (table.healthy) {
    const datasets::LeakSignal& signal = *result.settings.feature_signal;
    files.push_back({"features.csv", report::features_csv(result)});
    files.push_back({kHealthySeries, report::level_csv(signal, *table.healthy, nullptr)});
    for (const calib::FeatureRow& row : table.features) {
      files.push_back({kLevels / report::level_file(row.printed.level),
                       report::level_csv(signal, row.series, &*table.healthy)});
    }
  }
  report::StoredLeakTable stored = report::stored(result);
  report::name_files(files, stored.provenance);
  files.push_back({"leak_table.json", report::json_text(json_of(stored))});
  return files;
}

}  // namespace rigcal::app
