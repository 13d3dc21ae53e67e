#include "calib/trust/plan.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/verb.hpp"
#include "datasets/prepare/load_record.hpp"
#include "datasets/prepare/time_holes.hpp"
#include "report/page/page_plan.hpp"
#include "report/run/result_page.hpp"
#include "report/store/folder.hpp"
#include "report/store/json.hpp"
#include "report/store/plan.hpp"

namespace rigcal::app {
namespace {

struct PlanRequest {
  CampaignOptions common;
  std::filesystem::path fit;
};

ExitCode run_plan(const PlanRequest& options, const Invocation& invocation) {
  const datasets::Campaign campaign = load(options.common);
  std::optional<report::EarlierFit> earlier;
  std::vector<std::filesystem::path> more_inputs;
  if (!options.fit.empty()) {
    earlier = report::read_fit(options.fit, campaign.rig.plant);
    more_inputs.push_back(options.fit);
  }
  std::vector<datasets::Record> records;
  for (const datasets::Condition& condition : campaign.conditions) {
    const bool taken =
        condition.use == datasets::Use::fit || condition.use == datasets::Use::validate;
    if (!taken || !condition.has_record()) continue;
    records.push_back(datasets::load_record(campaign, condition));
    datasets::require_no_holes(campaign, records.back());
  }
  report::HeldFolder held(options.common.out,
                          holding("plan", options.common.force, options.common.print));
  held.plan({{"plan.json", "report.html"}, {}});
  const report::Provenance provenance{invocation.command, 1, recorded(options.common),
                                      report::hash_inputs(campaign, records, more_inputs)};
  const calib::Plan plan =
      calib::plan(campaign, records, earlier ? &earlier->values : nullptr, options.common.threads);
  const report::StoredPlan stored = report::stored(campaign, plan, provenance);
  const report::Json json = report::json_of(stored);
  std::vector<report::ResultFile> files{{"plan.json", report::json_text(json)}};
  add_page(options.common.out, options.common.threads, files);
  report::write_results(held, files, provenance.inputs);
  print(options.common.print, {report::plan_headline(stored), report::plan_sections(stored)},
        options.common.out, {"plan.json", "report.html"}, json);
  return ExitCode::done;
}

}  // namespace

Run add_plan(CLI::App& verb) {
  const auto options = std::make_shared<PlanRequest>();
  add_campaign_options(verb, options->common);
  verb.add_option("--fit", options->fit,
                  "fit.json whose values are taken (default: the campaign's own)")
      ->check(not_empty());
  return [options](const Invocation& invocation) { return run_plan(*options, invocation); };
}

}  // namespace rigcal::app
