#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/verb.hpp"

namespace rigcal::app {

Run add_average(CLI::App& verb) {
  const auto options = std::make_shared<CampaignOptions>();
  add_campaign_options(verb, *options);
  return [options](const Invocation& invocation) {
    return run_job("average", *options, invocation, [&](const report::JobTerms& terms) {
      const datasets::Campaign campaign = load(*options);
      return report::average_job(campaign, report::averaged_records(campaign, terms), terms);
    });
  };
}

}  // namespace rigcal::app
