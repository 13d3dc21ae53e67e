#include "report/run/check.hpp"

#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/verb.hpp"

namespace rigcal::app {
namespace {

ExitCode run_check(const CampaignOptions& options) {
  const datasets::Campaign campaign = load(options);
  const report::Check found = report::check(campaign);
  print(options.print, found.text, found.json);
  return ExitCode::done;
}

}  // namespace

Run add_check(CLI::App& verb) {
  const auto options = std::make_shared<CampaignOptions>();
  add_campaign_options(verb, *options);
  return [options](const Invocation&) { return run_check(*options); };
}

}  // namespace rigcal::app
