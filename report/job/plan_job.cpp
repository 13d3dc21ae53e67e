#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "calib/design/design.hpp"
#include "calib/trust/plan.hpp"
#include "calib/trust/planned_record.hpp"
#include "datasets/campaign/design/drive_file.hpp"
#include "datasets/prepare/load_record.hpp"
#include "datasets/prepare/time_holes.hpp"
#include "report/job/job.hpp"
#include "report/page/page_parts.hpp"
#include "report/store/result_files.hpp"
#include "report/store/stored/stored_plan.hpp"
#include "report/store/table.hpp"

namespace rigcal::report {
namespace {

StoredPlan plan_file(const datasets::Campaign& campaign, const calib::Plan& plan,
                     const Provenance& provenance) {
  StoredPlan file;
  static_cast<calib::Plan&>(file) = plan;
  file.campaign = campaign.name;
  file.provenance = stored(provenance);
  return file;
}

StoredDesign design_file(const datasets::Campaign& campaign, const calib::Design& design) {
  const datasets::DesignSettings& settings = *campaign.design;
  const datasets::ChannelInfo& channel = datasets::info(datasets::drive_channel(campaign));
  StoredDesign file;
  static_cast<calib::DesignedTest&>(file) = design;
  file.status = design.stopped ? "stopped" : "done";
  file.criterion = settings.criterion;
  file.channel = channel.key;
  file.unit = channel.unit;
  file.duration_s = settings.duration_s;
  file.sample_rate_hz = settings.sample_rate_hz;
  file.repeats = settings.repeats;
  file.seed = settings.seed;
  if (settings.like) file.leak_level = campaign.find(*settings.like)->leak_level;
  for (const auto& [measured, sd] : design.noise_sd)
    file.noise_sd.emplace_back(datasets::info(measured).name, sd);
  for (const calib::LimitUse& use : design.limits)
    file.limits.push_back(
        {use.key, use.words, use.unit, use.limit, use.reached, 100.0 * use.share});
  return file;
}

/// Returns the predicted response to a designed drive in SI units, with one row for each sample of
/// the drive.
Table response_of(const datasets::Campaign& campaign, const calib::Design& design) {
  Table table;
  table.add("time_s", design.time_s);
  table.add(std::string(datasets::info(datasets::drive_channel(campaign)).name), design.samples);
  const auto outputs = calib::limited_outputs();
  const bool commanded = datasets::drive_channel(campaign) == datasets::Channel::command;
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    if (commanded && outputs[k] == model::Output::command) continue;  // it is the drive
    const auto column = design.response.col(static_cast<Eigen::Index>(k));
    table.add(std::string(model::output_name(outputs[k])),
              std::vector<double>(column.begin(), column.end()));
  }
  return table;
}

std::vector<datasets::Record> records_of(const datasets::Campaign& campaign) {
  std::vector<datasets::Record> records;
  for (const datasets::Condition& condition : campaign.conditions) {
    if (!calib::is_planned_with(condition) || !condition.has_record()) continue;
    records.push_back(datasets::load_record(campaign, condition));
    datasets::require_no_holes(campaign, records.back());
  }
  return records;
}

/// Plans with the records of the campaign. The plan is empty if the campaign has no condition and a
/// design is requested.
StoredPlan plan_of_records(const datasets::Campaign& campaign,
                           const std::vector<datasets::Record>& records,
                           const std::vector<datasets::FittedValue>* values, bool has_design,
                           const Provenance& provenance, int threads) {
  const bool any =
      std::any_of(campaign.conditions.begin(), campaign.conditions.end(), calib::is_planned_with);
  if (!any && has_design) return plan_file(campaign, {}, provenance);
  return plan_file(campaign, calib::plan(campaign, records, values, threads), provenance);
}

/// Designs a test and adds it to the result and its files.
void add_design(const datasets::Campaign& campaign, const std::vector<datasets::Record>& records,
                const std::vector<datasets::FittedValue>* values,
                const std::vector<std::string>& names, const JobTerms& terms,
                Omittable<StoredDesign>& designed, std::vector<ResultFile>& files) {
  const auto progress = [&](datasets::DriveFamily family, int tried, int most) {
    terms.progress(fmt::format("drives ({})", datasets::to_string(family)).c_str(), tried, most);
  };
  const calib::Design design =
      calib::design(campaign, records, names, values, {terms.threads, &terms.cancel, progress});
  designed.emplace(design_file(campaign, design));
  files.push_back({kDriveFile, datasets::drive_csv(campaign, design.time_s, design.samples)});
  files.push_back(table_file(kResponseFile, response_of(campaign, design)));
  files.push_back(
      {kDesignedCampaignFile, datasets::designed_campaign_text(campaign, *campaign.design,
                                                               design.family, design.noise_sd)});
}

}  // namespace

JobResult plan_job(const datasets::Campaign& campaign, const PlanRequest& request,
                   const JobTerms& terms) {
  std::optional<EarlierFit> earlier;
  if (request.fit.given()) earlier = request.fit.read(campaign.rig.plant);
  const std::vector<datasets::Record> records = records_of(campaign);
  const std::vector<datasets::FittedValue>* values = earlier ? &earlier->values : nullptr;
  const bool has_design = !request.design.empty();
  PlannedFiles planned{{"plan.json", "report.html"}, {}};
  for (const char* file : {kDriveFile, kResponseFile, kDesignedCampaignFile})
    planned.files.emplace_back(file);
  terms.hold(std::move(planned));
  Provenance provenance{terms.command, 1, terms.options,
                        hash_inputs(campaign, records, request.fit.inputs())};
  if (has_design) {
    if (campaign.design) provenance.seed = campaign.design->seed;
    provenance.options.emplace_back("design", fmt::format("{}", fmt::join(request.design, ",")));
  }
  JobResult job;
  Omittable<StoredDesign> designed;
  if (has_design) add_design(campaign, records, values, request.design, terms, designed, job.files);
  StoredPlan plan =
      plan_of_records(campaign, records, values, has_design, provenance, terms.threads);
  plan.design = std::move(designed);
  if (plan.design && plan.design->stopped()) job.code = ExitCode::stopped;
  if (!job.files.empty()) name_files(job.files, plan.provenance);
  job.files.push_back(json_file("plan.json", std::move(plan)));
  job.first = {"plan.json"};
  if (has_design) job.first.insert(job.first.end(), {kDriveFile, kDesignedCampaignFile});
  job.inputs = provenance.inputs;
  return job;
}

}  // namespace rigcal::report
