#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/verb.hpp"

namespace rigcal::app {
namespace {

struct DiagnoseOptions : report::DiagnosisRequest {
  CampaignOptions common;
};

}  // namespace

Run add_diagnose(CLI::App& verb) {
  const auto options = std::make_shared<DiagnoseOptions>();
  add_campaign_options(verb, options->common);
  verb.add_option("--fit", options->fit.file, "fit.json of a fit to healthy records of the rig")
      ->check(not_empty());
  verb.add_option("--table", options->table,
                  "leak_table.json of the same rig: its rows are the limits of the classes")
      ->check(not_empty());
  verb.add_option("--healthy", options->healthy,
                  "leak level that is healthy, besides those that the campaign knows; repeatable")
      ->allow_extra_args(false);
  return [options](const Invocation& invocation) {
    return run_job("diagnose", options->common, invocation, [&](const report::JobTerms& terms) {
      return report::diagnosis_job(load(options->common), *options, terms);
    });
  };
}

}  // namespace rigcal::app
