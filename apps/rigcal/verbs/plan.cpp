#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/verb.hpp"

namespace rigcal::app {
namespace {

struct PlanOptions {
  CampaignOptions common;
  report::FitSource fit;
};

}  // namespace

Run add_plan(CLI::App& verb) {
  const auto options = std::make_shared<PlanOptions>();
  add_campaign_options(verb, options->common);
  verb.add_option("--fit", options->fit.file,
                  "fit.json whose values are taken (default: the campaign's own)")
      ->check(not_empty());
  return [options](const Invocation& invocation) {
    return run_job("plan", options->common, invocation, [&](const report::JobTerms& terms) {
      return report::plan_job(load(options->common), options->fit, terms);
    });
  };
}

}  // namespace rigcal::app
