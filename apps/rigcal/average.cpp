#include <fmt/format.h>

#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/verb.hpp"
#include "report/run/averaging.hpp"
#include "report/run/result_page.hpp"
#include "report/store/folder.hpp"
#include "report/store/json.hpp"
#include "report/store/result_files.hpp"
#include "report/store/stored_provenance.hpp"
#include "report/text/repeatability_text.hpp"

namespace rigcal::app {
namespace {

ExitCode run_average(const CampaignOptions& options, const Invocation& invocation) {
  const datasets::Campaign campaign = load(options);
  const report::HeldFolder held(options.out);
  const std::vector<datasets::Record> records = report::averaged_records(campaign);
  report::Json json;
  json["schema"] = "rigcal.average/1";
  json["campaign"] = campaign.name;
  json["synthetic"] = campaign.synthetic;
  json["records"] = report::Json::array();
  for (const datasets::Record& record : records)
    json["records"].push_back(report::record_json(*campaign.find(record.condition), record));
  std::vector<report::ResultFile> files = report::averaged_files(records);
  const report::Provenance provenance{invocation.command, 1, recorded(options),
                                      report::hash_inputs(campaign, records)};
  json["provenance"] = report::json_of(report::stored(provenance));
  report::name_files(files, json);
  files.push_back({"average.json", report::json_text(json)});
  report::add_page(options.out, options.threads, files);
  report::write_results(options.out, files, provenance.inputs);
  std::string text = report::repeatability_text(campaign, records, terminal_style());
  text +=
      fmt::format("files: {} {} {} {}\n", (options.out / "average.json").string(),
                  (options.out / "repeatability.csv").string(),
                  (options.out / "averaged" / "").string(), (options.out / "report.html").string());
  print(options.print, text, json);
  return ExitCode::done;
}

}  // namespace

Run add_average(CLI::App& verb) {
  const auto options = std::make_shared<CampaignOptions>();
  add_campaign_options(verb, *options);
  return [options](const Invocation& invocation) { return run_average(*options, invocation); };
}

}  // namespace rigcal::app
