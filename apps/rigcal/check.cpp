#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/verb.hpp"
#include "datasets/checks/short_records.hpp"
#include "datasets/prepare/load_record.hpp"
#include "report/text/terminal.hpp"

namespace rigcal::app {
namespace {

ExitCode run_check(const CampaignOptions& options) {
  const datasets::Campaign campaign = load(options);
  report::Json json;
  json["campaign"] = campaign.name;
  json["synthetic"] = campaign.synthetic;
  json["records"] = report::Json::array();
  json["without_record"] = report::Json::array();
  std::vector<std::string> texts;               // per condition
  std::vector<datasets::RecordLength> lengths;  // of those with a record
  std::vector<std::size_t> places;              // of these, in `texts`
  for (const datasets::Condition& condition : campaign.conditions) {
    if (!condition.has_record()) {
      texts.push_back(fmt::format("{}: {}, no record\n", condition.id, to_string(condition.use)));
      json["without_record"].push_back(condition.id);
      continue;
    }
    // One record at a time is in memory.
    const datasets::Record record = datasets::load_record(campaign, condition);
    lengths.push_back({&condition, datasets::seconds_of(record)});
    places.push_back(texts.size());
    texts.push_back(report::record_text(condition, record));
    json["records"].push_back(report::record_json(condition, record));
  }
  const std::vector<std::string> warnings = datasets::short_records(lengths);
  for (std::size_t i = 0; i < warnings.size(); ++i) {
    if (warnings[i].empty()) continue;
    texts[places[i]] += fmt::format("  warning: {}\n", warnings[i]);
    json["records"][i]["warnings"].push_back(warnings[i]);
  }
  std::string text = fmt::format("{}", fmt::join(texts, ""));
  if (campaign.synthetic) text += "note: the records of this campaign are synthetic\n";
  print(options.print, text, json);
  return ExitCode::done;
}

}  // namespace

Run add_check(CLI::App& verb) {
  const auto options = std::make_shared<CampaignOptions>();
  add_campaign_options(verb, *options);
  return [options](const Invocation&) { return run_check(*options); };
}

}  // namespace rigcal::app
