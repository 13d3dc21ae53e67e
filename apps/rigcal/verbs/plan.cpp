#include "calib/trust/plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>

#include "apps/rigcal/interrupt.hpp"
#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/verb.hpp"
#include "calib/design/design.hpp"
#include "calib/trust/planned_record.hpp"
#include "datasets/campaign/design/drive_file.hpp"
#include "datasets/prepare/load_record.hpp"
#include "datasets/prepare/time_holes.hpp"
#include "report/page/page_plan.hpp"
#include "report/run/result_page.hpp"
#include "report/store/folder.hpp"
#include "report/store/json.hpp"
#include "report/store/plan.hpp"
#include "report/store/result_files.hpp"

namespace rigcal::app {
namespace {

struct PlanRequest {
  CampaignOptions common;
  std::filesystem::path fit;
  std::vector<std::string> design;  ///< parameters that a test is designed for
};

std::vector<datasets::Record> records_of(const datasets::Campaign& campaign) {
  std::vector<datasets::Record> records;
  for (const datasets::Condition& condition : campaign.conditions) {
    if (!calib::is_planned_with(condition) || !condition.has_record()) continue;
    records.push_back(datasets::load_record(campaign, condition));
    datasets::require_no_holes(campaign, records.back());
  }
  return records;
}

/// What the records tell; nothing where a design is asked for and the campaign has no condition.
report::StoredPlan plan_of_records(const datasets::Campaign& campaign,
                                   const std::vector<datasets::Record>& records,
                                   const std::vector<datasets::FittedValue>* values,
                                   const PlanRequest& options,
                                   const report::Provenance& provenance) {
  const bool any =
      std::any_of(campaign.conditions.begin(), campaign.conditions.end(), calib::is_planned_with);
  if (!any && !options.design.empty()) return report::stored(campaign, {}, provenance);
  return report::stored(campaign, calib::plan(campaign, records, values, options.common.threads),
                        provenance);
}

/// Says on stderr how far the search is: at once for each family, then every few seconds.
class DesignProgress {
 public:
  explicit DesignProgress(bool quiet) : quiet_(quiet) {}

  void operator()(datasets::DriveFamily family, int tried, int most) {
    using Clock = std::chrono::steady_clock;
    constexpr auto kPause = std::chrono::seconds(3);
    const auto now = Clock::now();
    if (quiet_ || (family_ == family && now - told_ < kPause)) return;
    family_ = family;
    told_ = now;
    fmt::print(stderr, "design: {}, {} of {} drives tried\n", datasets::to_string(family), tried,
               most);
  }

 private:
  bool quiet_;
  std::optional<datasets::DriveFamily> family_;
  std::chrono::steady_clock::time_point told_;
};

/// Designs a test and adds it to the result and to its files.
report::Table add_design(const datasets::Campaign& campaign,
                         const std::vector<datasets::Record>& records,
                         const std::vector<datasets::FittedValue>* values,
                         const PlanRequest& options, const std::atomic<bool>& cancel,
                         report::StoredPlan& plan, std::vector<report::ResultFile>& files) {
  DesignProgress progress(options.common.print.quiet);
  const calib::Design design = calib::design(campaign, records, options.design, values,
                                             {options.common.threads, &cancel, std::ref(progress)});
  plan.design = report::stored(campaign, design);
  report::Table response = report::response_of(campaign, design);
  files.push_back({report::kDriveFile, datasets::drive_csv(campaign, design.time_s, design.drive)});
  files.push_back({report::kResponseFile, report::csv_of(response)});
  files.push_back({report::kDesignedCampaignFile,
                   datasets::designed_campaign_text(campaign, *campaign.design, design.family,
                                                    design.noise_sd)});
  return response;
}

ExitCode run_plan(const PlanRequest& options, const Invocation& invocation) {
  const datasets::Campaign campaign = load(options.common);
  std::optional<report::EarlierFit> earlier;
  std::vector<std::filesystem::path> more_inputs;
  if (!options.fit.empty()) {
    earlier = report::read_fit(options.fit, campaign.rig.plant);
    more_inputs.push_back(options.fit);
  }
  const std::vector<datasets::Record> records = records_of(campaign);
  const std::vector<datasets::FittedValue>* values = earlier ? &earlier->values : nullptr;
  // A signal ends a plan at once; of a design it keeps the best drive until then.
  const auto kept = options.design.empty() ? nullptr : std::make_unique<const Kept>();
  report::HeldFolder held(options.common.out,
                          holding("plan", options.common.force, options.common.print));
  report::PlannedFiles planned{{"plan.json", "report.html"}, {}};
  for (const char* file :
       {report::kDriveFile, report::kResponseFile, report::kDesignedCampaignFile})
    planned.files.emplace_back(file);
  held.plan(std::move(planned));
  report::Provenance provenance{invocation.command, 1, recorded(options.common),
                                report::hash_inputs(campaign, records, more_inputs)};
  if (!options.design.empty()) {
    if (campaign.design) provenance.seed = campaign.design->seed;
    provenance.options.emplace_back("design", fmt::format("{}", fmt::join(options.design, ",")));
  }
  report::PlanFiles result;
  std::vector<report::ResultFile> files;
  report::StoredPlan designed;
  if (!options.design.empty())
    result.response =
        add_design(campaign, records, values, options, invocation.cancel, designed, files);
  result.result = plan_of_records(campaign, records, values, options, provenance);
  result.result.design = designed.design;
  if (!files.empty()) report::name_files(files, result.result.provenance);
  const report::Json json = report::json_of(result.result);
  files.push_back({"plan.json", report::json_text(json)});
  add_page(options.common.out, options.common.threads, files);
  report::write_results(held, files, provenance.inputs);
  std::vector<std::string> shown{"plan.json", "report.html"};
  if (designed.design)
    shown.insert(shown.end(), {report::kDriveFile, report::kDesignedCampaignFile});
  print(options.common.print, {report::plan_headline(result), report::plan_sections(result)},
        options.common.out, shown, json);
  return designed.design && designed.design->stopped() ? ExitCode::stopped : ExitCode::done;
}

}  // namespace

Run add_plan(CLI::App& verb) {
  const auto options = std::make_shared<PlanRequest>();
  add_campaign_options(verb, options->common);
  verb.add_option("--fit", options->fit,
                  "fit.json whose values are taken (default: the campaign's own)")
      ->check(not_empty());
  verb.add_option("--design", options->design,
                  "Design a test for these parameters, within the limits of [design]")
      ->delimiter(',')
      ->check(not_empty());
  return [options](const Invocation& invocation) { return run_plan(*options, invocation); };
}

}  // namespace rigcal::app
