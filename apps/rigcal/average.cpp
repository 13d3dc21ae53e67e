#include <fmt/format.h>

#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/verb.hpp"
#include "report/run/averaging.hpp"
#include "report/store/folder.hpp"
#include "report/text/repeatability_text.hpp"

namespace rigcal::app {
namespace {

ExitCode run_average(const CampaignOptions& options) {
  const datasets::Campaign campaign = load(options);
  const report::HeldFolder held(options.out);
  const std::vector<datasets::Record> records = report::averaged_records(campaign);
  report::Json json;
  json["campaign"] = campaign.name;
  json["records"] = report::Json::array();
  for (const datasets::Record& record : records)
    json["records"].push_back(report::record_json(*campaign.find(record.condition), record));
  report::write_results(options.out, report::averaged_files(records),
                        report::hash_inputs(campaign, records));
  std::string text = report::repeatability_text(campaign, records, terminal_style());
  text += fmt::format("files: {} {}\n", (options.out / "repeatability.csv").string(),
                      (options.out / "averaged" / "").string());
  print(options.print, text, json);
  return ExitCode::done;
}

}  // namespace

Run add_average(CLI::App& verb) {
  const auto options = std::make_shared<CampaignOptions>();
  add_campaign_options(verb, *options);
  return [options](const Invocation&) { return run_average(*options); };
}

}  // namespace rigcal::app
