#include <fmt/format.h>

#include <memory>
#include <vector>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/verb.hpp"
#include "report/live/explore_page.hpp"
#include "report/store/folder.hpp"

namespace rigcal::app {
namespace {

struct ExploreOptions : CampaignOptions {
  std::filesystem::path fit;
};

ExitCode run_explore(const ExploreOptions& options, const Invocation& invocation) {
  const datasets::Campaign campaign = load(options);
  std::vector<datasets::FittedValue> fitted;
  std::vector<std::filesystem::path> more_inputs;
  if (!options.fit.empty()) {
    fitted = report::read_fit(options.fit, campaign.rig.plant).values;
    more_inputs.push_back(options.fit);
  }
  const std::vector<report::LiveCase> cases = report::live_cases(campaign, fitted);
  std::vector<datasets::Record> records;
  for (const report::LiveCase& each : cases)
    if (each.task.record) records.push_back(*each.task.record);
  const std::vector<report::InputFile> inputs = report::hash_inputs(campaign, records, more_inputs);
  report::HeldFolder held(options.out, holding("explore", options.force, options.print));
  held.plan({{"explore.html"}, {}});
  const std::vector<report::ResultFile> files{
      {"explore.html", report::explore_page(campaign, cases, invocation.command, inputs)}};
  report::write_results(held, files, inputs);
  const std::string page = (options.out / "explore.html").string();
  report::Json json;
  json["files"] = {page};
  json["cases"] = report::Json::array();
  for (const report::LiveCase& each : cases) json["cases"].push_back(each.name);
  print(options.print, fmt::format("{} cases\nfiles: {}\n", cases.size(), page), json);
  return ExitCode::done;
}

}  // namespace

Run add_explore(CLI::App& verb) {
  const auto options = std::make_shared<ExploreOptions>();
  add_campaign_options(verb, *options);
  verb.add_option("--fit", options->fit,
                  "fit.json whose values the rig starts with (default: the campaign's own)")
      ->check(not_empty());
  return [options](const Invocation& invocation) { return run_explore(*options, invocation); };
}

}  // namespace rigcal::app
