#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/verb.hpp"

namespace rigcal::app {
namespace {

struct ValidateOptions : report::ValidationRequest {
  CampaignOptions common;
};

}  // namespace

Run add_validate(CLI::App& verb) {
  const auto options = std::make_shared<ValidateOptions>();
  add_campaign_options(verb, options->common);
  verb.add_option("--fit", options->fit.file,
                  "fit.json of an earlier fit (default: the campaign's own values)")
      ->check(not_empty());
  add_strict_option(verb, options->strict);
  return [options](const Invocation& invocation) {
    return run_job(
        "validate", options->common, invocation,
        [&](const report::JobTerms& terms) {
          return report::validation_job(loaded(options->common), *options, terms);
        },
        OnSignal::keep_result);
  };
}

}  // namespace rigcal::app
