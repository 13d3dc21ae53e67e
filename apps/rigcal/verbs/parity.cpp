#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/verb.hpp"

namespace rigcal::app {
namespace {

struct ParityOptions : report::ParityRequest {
  CampaignOptions common;
};

}  // namespace

Run add_parity(CLI::App& verb) {
  const auto options = std::make_shared<ParityOptions>();
  add_campaign_options(verb, options->common);
  verb.add_option("--fit", options->fit.file, "fit.json of a fit to healthy records of the rig");
  verb.add_option("--false-alarms", options->false_alarm_percent,
                  "percentage of healthy records that raise an alarm (default 1)");
  verb.add_option("--healthy", options->healthy,
                  "leak level that is healthy, besides those that the campaign knows; repeatable");
  return [options](const Invocation& invocation) {
    return run_job("parity", options->common, invocation, [&](const report::JobTerms& terms) {
      return report::parity_job(load(options->common), *options, terms);
    });
  };
}

}  // namespace rigcal::app
