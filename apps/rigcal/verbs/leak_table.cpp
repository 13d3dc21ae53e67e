#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/verb.hpp"

namespace rigcal::app {
namespace {

struct LeakTableOptions : report::LeakTableRequest {
  CampaignOptions common;
};

}  // namespace

Run add_leak_table(CLI::App& verb) {
  const auto options = std::make_shared<LeakTableOptions>();
  add_campaign_options(verb, options->common);
  verb.add_option("--fit", options->fit.file,
                  "fit.json of a fit of the rig: its values, with intervals of the coefficients")
      ->check(not_empty());
  verb.add_option("--targets", options->targets_percent,
                  "Shares of the servo flow in percent: 5,15,25 (default: the campaign's)")
      ->delimiter(',')
      ->check(CLI::Range(1e-3, 1000.0))
      ->allow_extra_args(false);
  verb.add_option("--signals", options->signals,
                  "Drives: sine@0.1Hz,square@10Hz@20mm (default: the campaign's)")
      ->delimiter(',')
      ->allow_extra_args(false);
  return [options](const Invocation& invocation) {
    return run_job("leak-table", options->common, invocation, [&](const report::JobTerms& terms) {
      return report::leak_table_job(options->common, *options, terms);
    });
  };
}

}  // namespace rigcal::app
