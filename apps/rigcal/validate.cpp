#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "apps/rigcal/earlier_fit.hpp"
#include "apps/rigcal/interrupt.hpp"
#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/progress.hpp"
#include "apps/rigcal/verb.hpp"
#include "calib/fit.hpp"
#include "datasets/prepare/load_record.hpp"
#include "report/store/folder.hpp"
#include "report/store/validity.hpp"

namespace rigcal::app {
namespace {

using datasets::Campaign;
using datasets::Use;

struct ValidateRequest {
  CampaignOptions common;
  std::filesystem::path fit;
  bool strict = false;
};

std::vector<std::string> warnings_of(const Campaign& campaign,
                                     const std::vector<datasets::Record>& records,
                                     const calib::Fit& fit, const report::EarlierFit& earlier) {
  std::vector<std::string> warnings = doubts_about(earlier, campaign);
  const auto outside = report::outside(
      report::coverage(campaign, records, fit, {Use::fit, Use::validate}), earlier.validity);
  warnings.insert(warnings.end(), outside.begin(), outside.end());
  return warnings;
}

/// Which of the records the earlier fit was estimated from: by their content, since names may stay
/// where recordings are new ones.
calib::Origin origin_of(const report::EarlierFit& earlier,
                        const std::vector<datasets::Record>& records,
                        const report::Provenance& provenance) {
  const auto seen = [&](const FileState& file) {
    const auto input = std::find_if(provenance.inputs.begin(), provenance.inputs.end(),
                                    [&](const auto& each) { return each.path == file.path; });
    return input != provenance.inputs.end() &&
           std::find(earlier.input_hashes.begin(), earlier.input_hashes.end(), input->sha256) !=
               earlier.input_hashes.end();
  };
  calib::Origin origin;
  origin.parameters = earlier.parameters;
  for (const datasets::Record& record : records) {
    if (std::none_of(record.files.begin(), record.files.end(), seen)) continue;
    const auto then =
        std::find_if(earlier.conditions.begin(), earlier.conditions.end(),
                     [&](const auto& each) { return each.first == record.condition; });
    // A file that the fit read under another name counts as one that it was estimated from.
    if (then == earlier.conditions.end() || then->second == Use::fit)
      origin.estimated_from.insert(record.condition);
  }
  return origin;
}

ExitCode run_validate(const ValidateRequest& options, const Invocation& invocation) {
  const Campaign campaign = load(options.common);
  std::optional<report::EarlierFit> earlier;
  std::vector<std::filesystem::path> more_inputs;
  if (!options.fit.empty()) {
    earlier = report::read_fit(options.fit, campaign.rig.plant);
    more_inputs.push_back(options.fit);
  }
  const auto records =
      datasets::load_records(campaign, {Use::fit, Use::validate}, options.common.threads);
  calib::FitOptions settings = fit_options(options.common, campaign, invocation.cancel);
  const report::Provenance provenance{invocation.command, settings.seed, recorded(options.common),
                                      report::hash_inputs(campaign, records, more_inputs)};
  const Kept kept;
  const report::HeldFolder held(options.common.out);

  calib::Fit fit;
  {
    FitProgress progress(options.common.print.quiet, "nuisance parameters", settings);
    settings.progress = std::ref(progress);
    const auto origin =
        earlier ? std::optional(origin_of(*earlier, records, provenance)) : std::nullopt;
    fit = calib::validate(campaign, records, earlier ? &earlier->values : nullptr, settings,
                          origin ? &*origin : nullptr);
  }
  if (earlier) {
    const auto warnings = warnings_of(campaign, records, fit, *earlier);
    fit.warnings.insert(fit.warnings.end(), warnings.begin(), warnings.end());
  }
  return write_and_print(options.common,
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
