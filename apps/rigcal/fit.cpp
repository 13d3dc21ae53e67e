#include "calib/fit.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>

#include "apps/rigcal/checkpoint_file.hpp"
#include "apps/rigcal/interrupt.hpp"
#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/progress.hpp"
#include "apps/rigcal/verb.hpp"
#include "datasets/prepare/load_record.hpp"
#include "report/store/folder.hpp"

namespace rigcal::app {
namespace {

constexpr int kMostStarts = 100'000;
/// Where nobody said how many starts to make and the campaign's ends at no minimum.
constexpr int kFurtherStarts = 3;
constexpr int kMostReplicates = 1'000'000;

struct FitRequest {
  CampaignOptions common;
  std::optional<int> starts;
  std::uint64_t seed = 1;
  int bootstrap = 0;
  bool profiles = false;
  bool cross_validate = false;
  bool resume = false;
  bool strict = false;
  std::optional<double> max_time_s;
  std::optional<long> max_evaluations;
};

/// CLI11's own check of a positive number lets "nan" and "inf" pass.
CLI::Validator finite_positive() {
  return CLI::Validator(
      [](std::string& text) {
        double value = 0.0;
        const bool valid =
            CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value > 0.0;
        return valid ? std::string() : fmt::format("found {}, expected a number above zero", text);
      },
      "POSITIVE");
}

/// A fit that begins anew must not look as if it went on.
void say_nothing_to_resume(const FitRequest& options, int starts) {
  std::fputs(
      fmt::format("no checkpoint in {}{}: the fit begins anew\n", options.common.out.string(),
                  starts > 1 ? "" : " (a fit of one start keeps none)")
          .c_str(),
      stderr);
}

ExitCode run_fit(const FitRequest& options, const Invocation& invocation) {
  const datasets::Campaign campaign = load(options.common);
  const auto records = datasets::load_records(
      campaign, {datasets::Use::fit, datasets::Use::validate}, options.common.threads, true);
  calib::FitOptions settings = fit_options(options.common, campaign, invocation.cancel);
  settings.starts = options.starts.value_or(settings.starts);
  if (!options.starts) settings.further_starts = kFurtherStarts;
  settings.seed = options.seed;
  settings.bootstrap = options.bootstrap;
  settings.profiles = options.profiles;
  settings.cross_validate = options.cross_validate;
  settings.max_evaluations = options.max_evaluations;
  if (options.max_time_s) settings.max_seconds = options.max_time_s;
  report::Provenance provenance{invocation.command, options.seed, recorded(options.common),
                                report::hash_inputs(campaign, records)};
  provenance.options.emplace_back("starts", fmt::format("{}", settings.starts));
  const Kept kept;
  const report::HeldFolder held(options.common.out);

  CheckpointFile checkpoint(options.common.out, provenance);
  const auto earlier = options.resume ? checkpoint.read() : std::nullopt;
  if (earlier) settings.resume = &*earlier;
  if (options.resume && !earlier && !options.common.print.quiet)
    say_nothing_to_resume(options, settings.starts);
  if (settings.starts > 1)
    settings.checkpoint = [&](const calib::Checkpoint& reached) { checkpoint.keep(reached); };

  calib::Fit fit;
  {
    FitProgress progress(options.common.print.quiet,
                         settings.starts > 1 ? fmt::format("start {{}} of {}", settings.starts)
                                             : std::string("start {}"),
                         settings);
    settings.progress = std::ref(progress);
    BesideProgress beside(options.common.print.quiet);
    settings.beside = std::ref(beside);
    fit = calib::fit(campaign, records, settings);
  }
  const ExitCode code =
      write_and_print(options.common, {report::ResultKind::fit, campaign, records, fit, provenance},
                      options.strict);
  checkpoint.finish(fit.status);
  return code;
}

}  // namespace

Run add_fit(CLI::App& verb) {
  const auto options = std::make_shared<FitRequest>();
  add_campaign_options(verb, options->common);
  verb.add_option(
          "--starts", options->starts,
          "Number of starts (default: the campaign's, or 1, and 3 more where that ends at no "
          "minimum); the best result counts")
      ->check(CLI::Range(1, kMostStarts));
  verb.add_option("--seed", options->seed, "Seed of the further starts")
      ->check(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
      ->capture_default_str();
  verb.add_option("--bootstrap", options->bootstrap,
                  "Intervals from so many fits to redrawn repeats or residuals")
      ->check(CLI::Range(0, kMostReplicates));
  verb.add_flag("--profiles", options->profiles, "Profile likelihood of every parameter");
  verb.add_flag("--cross-validate", options->cross_validate,
                "Leave out one condition after the other and predict it");
  verb.add_flag("--resume", options->resume,
                "Go on where a fit of the same inputs and options was stopped or killed");
  verb.add_option(
          "--max-time", options->max_time_s,
          "Stop after so many seconds, bootstrap and all (default: the campaign's, or none)")
      ->check(finite_positive());
  verb.add_option("--max-evaluations", options->max_evaluations,
                  "Stop after so many evaluations of all conditions")
      ->check(whole_number(1, std::numeric_limits<long>::max()));
  add_strict_option(verb, options->strict);
  return [options](const Invocation& invocation) { return run_fit(*options, invocation); };
}

}  // namespace rigcal::app
