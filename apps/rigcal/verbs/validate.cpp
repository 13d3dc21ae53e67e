#include <memory>
#include <optional>

#include "apps/rigcal/interrupt.hpp"
#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/progress.hpp"
#include "apps/rigcal/verb.hpp"
#include "calib/fit.hpp"
#include "datasets/prepare/load_record.hpp"
#include "report/run/fit_choices.hpp"
#include "report/run/validation.hpp"
#include "report/run/write_result.hpp"
#include "report/store/folder.hpp"

namespace rigcal::app {
namespace {

using datasets::Campaign;
using datasets::Use;

struct ValidateRequest {
  CampaignOptions common;
  std::filesystem::path fit;
  bool strict = false;
};

ExitCode run_validate(const ValidateRequest& options, const Invocation& invocation) {
  const Campaign campaign = load(options.common);
  std::optional<report::EarlierFit> earlier;
  std::vector<std::filesystem::path> more_inputs;
  if (!options.fit.empty()) {
    earlier = report::read_fit(options.fit, campaign.rig.plant);
    more_inputs.push_back(options.fit);
  }
  const auto records =
      datasets::load_records(campaign, {Use::fit, Use::validate}, options.common.threads, true);
  calib::FitOptions settings =
      report::fit_options(campaign, options.common.threads, invocation.cancel);
  const report::Provenance provenance{invocation.command, settings.seed, recorded(options.common),
                                      report::hash_inputs(campaign, records, more_inputs)};
  const Kept kept;
  report::HeldFolder held(options.common.out,
                          holding("validate", options.common.force, options.common.print));
  held.plan(report::planned_result(report::ResultKind::validation, campaign));

  calib::Fit fit;
  {
    FitProgress progress(options.common.print.quiet, "nuisance parameters", settings);
    settings.progress = std::ref(progress);
    fit = report::validate(campaign, records, earlier ? &*earlier : nullptr, provenance, settings);
  }
  return write_and_print(held, options.common,
                         {report::ResultKind::validation, campaign, records, fit, provenance},
                         options.strict);
}

}  // namespace

Run add_validate(CLI::App& verb) {
  const auto options = std::make_shared<ValidateRequest>();
  add_campaign_options(verb, options->common);
  verb.add_option("--fit", options->fit,
                  "fit.json of an earlier fit (default: the campaign's own values)")
      ->check(not_empty());
  add_strict_option(verb, options->strict);
  return [options](const Invocation& invocation) { return run_validate(*options, invocation); };
}

}  // namespace rigcal::app
