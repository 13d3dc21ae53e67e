#include <memory>

#include "apps/rigcal/fit_choices.hpp"
#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/verb.hpp"

namespace rigcal::app {
namespace {

struct FitOptions {
  CampaignOptions common;
  FitChoices choices;
  bool resume = false;
  bool if_changed = false;
};

}  // namespace

Run add_fit(CLI::App& verb) {
  const auto options = std::make_shared<FitOptions>();
  add_campaign_options(verb, options->common);
  add_fit_choices(verb, options->choices);
  verb.add_flag("--resume", options->resume,
                "Continue a fit of the same inputs and options that was stopped or killed");
  verb.add_flag("--if-changed", options->if_changed,
                "Do nothing if --out has the complete result of the same inputs and options");
  return [options](const Invocation& invocation) {
    const FitChoices& choices = options->choices;
    const report::FitRequest request{choices, choices.strict, options->resume, options->if_changed};
    return run_job(
        "fit", options->common, invocation,
        [&](const report::JobTerms& terms) {
          return report::fit_job(loaded(options->common), request, terms);
        },
        OnSignal::keep_result);
  };
}

}  // namespace rigcal::app
