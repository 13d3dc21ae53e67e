#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/verb.hpp"

namespace rigcal::app {
namespace {

struct SimulateOptions : report::SimulationRequest {
  CampaignOptions common;
};

/// Loads the campaign with the values to simulate.
datasets::Campaign load_to_simulate(const CampaignOptions& options) {
  CampaignOptions unchanged = options;
  unchanged.set.clear();
  datasets::Campaign campaign = load(unchanged);
  for (const std::string& assignment : options.set) datasets::set_everywhere(campaign, assignment);
  if (!options.set.empty()) datasets::check_values(campaign);
  return campaign;
}

}  // namespace

Run add_simulate(CLI::App& verb) {
  const auto options = std::make_shared<SimulateOptions>();
  add_campaign_options(verb, options->common);
  verb.add_option("--condition", options->conditions,
                  "Only this condition; repeatable (default: all that are not ignored)")
      ->allow_extra_args(false);
  return [options](const Invocation& invocation) {
    const datasets::Campaign campaign = load_to_simulate(options->common);
    return run_job("simulate", options->common, invocation, [&](const report::JobTerms& terms) {
      return report::simulation_job(campaign, *options, terms);
    });
  };
}

}  // namespace rigcal::app
