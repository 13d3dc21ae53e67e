#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/verb.hpp"

namespace rigcal::app {

Run add_fit_tables(CLI::App& verb) {
  const auto options = std::make_shared<CampaignOptions>();
  add_campaign_options(verb, *options);
  return [options](const Invocation& invocation) {
    return run_job(
        "fit-tables", *options, invocation,
        [&](const report::JobTerms& terms) { return report::fit_tables_job(*options, terms); },
        OnSignal::keep_result);
  };
}

}  // namespace rigcal::app
