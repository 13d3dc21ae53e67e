#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/verb.hpp"
#include "report/run/synthesis.hpp"
#include "report/store/folder.hpp"

namespace rigcal::app {
namespace {

struct SynthesizeRequest {
  CampaignOptions common;
  std::uint64_t seed = 1;
};

ExitCode run_synthesize(const SynthesizeRequest& options) {
  const CampaignOptions& common = options.common;
  const datasets::Campaign campaign = load(common);
  report::HeldFolder held(common.out, holding("synthesize", common.force, common.print));
  const datasets::SynthesisReport made =
      report::write_synthesis(held, campaign, options.seed, common.threads);
  report::Json json;
  json["campaign_file"] = made.campaign_file.string();
  json["files"] = made.files;
  json["samples"] = made.samples;
  json["seed"] = options.seed;
  print(common.print,
        fmt::format("{}: {} synthetic records, {} samples, seed {}\n", made.campaign_file.string(),
                    made.files, made.samples, options.seed),
        json);
  return ExitCode::done;
}

}  // namespace

Run add_synthesize(CLI::App& verb) {
  const auto options = std::make_shared<SynthesizeRequest>();
  add_campaign_options(verb, options->common);
  verb.add_option("--seed", options->seed, "Seed of the noise")
      ->required()
      ->check(whole_number(0, std::numeric_limits<std::uint64_t>::max()));
  return [options](const Invocation&) { return run_synthesize(*options); };
}

}  // namespace rigcal::app
