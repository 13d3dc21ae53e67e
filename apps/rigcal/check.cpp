#include <fmt/format.h>

#include <memory>

#include "apps/rigcal/interrupt.hpp"
#include "apps/rigcal/options.hpp"
#include "apps/rigcal/verb.hpp"
#include "datasets/load_record.hpp"
#include "report/terminal.hpp"

namespace rigcal::app {
namespace {

ExitCode run_check(const CampaignOptions& options, const Invocation& invocation) {
  const datasets::Campaign campaign = load(options);
  std::string text;
  report::Json json;
  json["campaign"] = campaign.name;
  json["synthetic"] = campaign.synthetic;
  json["records"] = report::Json::array();
  json["without_record"] = report::Json::array();
  for (const datasets::Condition& condition : campaign.conditions) {
    stop_if(invocation.cancel);
    if (!condition.has_record()) {
      text += fmt::format("{}: {}, no record\n", condition.id, to_string(condition.use));
      json["without_record"].push_back(condition.id);
      continue;
    }
    const datasets::Record record = datasets::load_record(campaign, condition);
    text += report::record_text(condition, record);
    json["records"].push_back(report::record_json(condition, record));
  }
  if (campaign.synthetic) text += "note: the records of this campaign are synthetic\n";
  print(options.print, text, json);
  return ExitCode::done;
}

}  // namespace

Run add_check(CLI::App& verb) {
  const auto options = std::make_shared<CampaignOptions>();
  add_campaign_options(verb, *options);
  return [options](const Invocation& invocation) { return run_check(*options, invocation); };
}

}  // namespace rigcal::app
