#include <memory>

#include "apps/rigcal/interrupt.hpp"
#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/verb.hpp"

namespace rigcal::app {
namespace {

struct PlanOptions : report::PlanRequest {
  CampaignOptions common;
};

}  // namespace

Run add_plan(CLI::App& verb) {
  const auto options = std::make_shared<PlanOptions>();
  add_campaign_options(verb, options->common);
  verb.add_option("--fit", options->fit.file,
                  "fit.json whose values are taken (default: the campaign's own)")
      ->check(not_empty());
  verb.add_option("--design", options->design,
                  "Design a test for these parameters, within the limits of [design]")
      ->delimiter(',')
      ->check(not_empty());
  return [options](const Invocation& invocation) {
    // A signal ends a plan at once. During a design the best drive so far is kept.
    const auto kept = options->design.empty() ? nullptr : std::make_unique<const Kept>();
    return run_job("plan", options->common, invocation, [&](const report::JobTerms& terms) {
      return report::plan_job(load(options->common), *options, terms);
    });
  };
}

}  // namespace rigcal::app
