#include "report/job/leak_table_files.hpp"

#include <algorithm>

#include "report/live/live_fit.hpp"
#include "report/live/live_rig.hpp"
#include "report/store/json.hpp"
#include "report/store/result_files.hpp"
#include "report/store/stored.hpp"

namespace rigcal::report {
namespace {

constexpr std::string_view kResidualScale = "residual_scale=";

const std::filesystem::path kLevels = "levels";
const std::filesystem::path kHealthySeries = kLevels / "healthy.csv";

}  // namespace

LeakTableInput load_leak_table(const CampaignChoice& choice) {
  CampaignChoice of_campaign = choice;
  // The residual scale is not a parameter of the rig; only the leak table has it.
  std::erase_if(of_campaign.set,
                [](const std::string& text) { return text.starts_with(kResidualScale); });
  of_campaign.free.clear();  // the leak table has free parameters of its own
  LeakTableInput input{load(of_campaign), {}};
  input.settings = leak_table_settings(input.campaign);
  for (const std::string& assignment : choice.set) {
    override_assumption(input.settings, input.campaign, assignment);
  }
  if (!choice.free.empty()) free_assumptions(input.settings, input.campaign, choice.free);
  return input;
}

diagnosis::LeakTableOptions leak_table_options(const datasets::Campaign& campaign, int threads,
                                               const std::atomic<bool>& cancel) {
  diagnosis::LeakTableOptions result;
  model::SimulationOptions& simulation = result.periodic.simulation;
  simulation.method = campaign.simulation.method;
  simulation.tolerance = campaign.simulation.tolerance.value_or(simulation.tolerance);
  simulation.max_seconds = campaign.simulation.max_seconds;
  simulation.cancel = &cancel;
  result.threads = threads;
  return result;
}

PlannedFiles planned_leak_table(const datasets::LeakTableSettings& settings) {
  PlannedFiles planned{{"leak_table.json", "leak_table.csv", "features.csv", kLiveLeakTableFile,
                        "report.html", kHealthySeries},
                       {kLevels}};
  for (const datasets::PrintedFeatures& features : settings.features)
    planned.files.push_back(kLevels / level_file(features.level));
  return planned;
}

std::vector<ResultFile> leak_table_files(const datasets::Campaign& campaign,
                                         const datasets::LeakTableSettings& settings,
                                         StoredLeakTable table) {
  const bool closed_loop = campaign.rig.controller == model::ControllerKind::pid;
  std::vector<ResultFile> files;
  files.push_back({"leak_table.csv", leak_table_csv(table, closed_loop)});
  if (table.healthy) {
    const datasets::LeakSignal& signal = *settings.feature_signal;
    files.push_back({"features.csv", features_csv(table)});
    files.push_back(table_file(kHealthySeries, level_table(signal, *table.healthy, nullptr)));
    for (const diagnosis::FeatureRow& row : table.features) {
      files.push_back(table_file(kLevels / level_file(row.level),
                                 level_table(signal, row.series, &*table.healthy)));
    }
  }
  Json rig = live_rig(campaign, leak_table_cases(campaign, settings));
  rig["embedded"] = true;
  files.push_back(json_file(kLiveLeakTableFile, std::move(rig), json_line));
  name_files(files, table.provenance);
  files.push_back(json_file("leak_table.json", std::move(table)));
  return files;
}

}  // namespace rigcal::report
