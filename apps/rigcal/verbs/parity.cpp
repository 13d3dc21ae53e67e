#include "diagnosis/parity.hpp"

#include <fmt/format.h>

#include <functional>
#include <memory>

#include "apps/rigcal/leak_records.hpp"
#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/progress.hpp"
#include "apps/rigcal/verb.hpp"
#include "diagnosis/obstacles.hpp"
#include "report/leak/parity.hpp"
#include "report/page/page_parts.hpp"
#include "report/run/result_page.hpp"
#include "report/store/folder.hpp"
#include "report/store/json.hpp"
#include "report/store/result_files.hpp"

namespace rigcal::app {
namespace {

struct ParityRequest {
  CampaignOptions common;
  std::filesystem::path fit;
  double false_alarm_percent = 1.0;
  std::vector<std::string> healthy;
};

ExitCode write_parity(report::HeldFolder& held, const ParityRequest& options,
                      const report::ParityResult& result) {
  report::StoredParity parity = report::stored(result);
  std::vector<report::ResultFile> files = report::parity_series(result);
  files.push_back({"parity.csv", report::parity_csv(result)});
  report::name_files(files, parity.provenance);
  const report::Json json = report::json_of(parity);
  files.push_back({"parity.json", report::json_text(json)});
  add_page(options.common.out, options.common.threads, files);
  report::write_results(held, files, result.provenance.inputs);
  const report::ParityFiles stored{std::move(parity), {}};
  print(options.common.print,
        {report::parity_headline(stored), report::parity_sections(stored), stored.result.synthetic},
        options.common.out, {"parity.json", "parity.csv", "parity/", "report.html"}, json);
  return report::status_of(result) == report::LeakStatus::done ? ExitCode::done
                                                               : ExitCode::no_result;
}

ExitCode run_parity(const ParityRequest& options, const Invocation& invocation) {
  datasets::Campaign campaign = load(options.common);
  take_healthy(options.healthy, campaign);
  if (options.fit.empty())
    throw UsageError("parity: --fit is missing: expected the fit.json of a fit to healthy records");
  const double false_alarm = options.false_alarm_percent / 100.0;
  if (!(false_alarm > 0.0 && false_alarm < 0.5)) {
    throw UsageError(fmt::format("--false-alarms {:g}: expected a percentage above 0 and below 50",
                                 options.false_alarm_percent));
  }
  const std::vector<std::string> reasons = diagnosis::obstacles(campaign, true);
  auto recorded_options = recorded(options.common);
  recorded_options.emplace_back("false_alarms_percent",
                                fmt::format("{:g}", options.false_alarm_percent));
  for (const std::string& level : options.healthy) recorded_options.emplace_back("healthy", level);
  report::Provenance provenance{invocation.command, 0, recorded_options, {}};
  report::HeldFolder held(options.common.out,
                          holding("parity", options.common.force, options.common.print));
  held.plan(report::planned_parity(campaign));
  diagnosis::Parity found;
  if (!reasons.empty()) {
    provenance.inputs = report::hash_inputs(campaign, {}, {options.fit});
    return write_parity(held, options, {campaign, found, reasons, false_alarm, provenance});
  }
  const report::EarlierFit earlier = report::read_fit(options.fit, campaign.rig.plant);
  const LeakRecords records = load_leak_records(campaign, options.common.threads);
  provenance.inputs = report::hash_inputs(campaign, records.averages(), {options.fit});
  {
    CountProgress progress(options.common.print.quiet, "conditions");
    diagnosis::ParityOptions settings;
    settings.false_alarm = false_alarm;
    settings.threads = options.common.threads;
    settings.progress = std::ref(progress);
    found = diagnosis::parity(campaign, records.conditions,
                              {earlier.values, earlier.indices, earlier.covariance}, settings);
  }
  found.warnings.insert(found.warnings.end(), records.left_out.begin(), records.left_out.end());
  for (const auto& warning : gathered_doubts(records.averages()))
    found.warnings.push_back(warning.with_conditions());
  if (earlier.status == calib::FitStatus::stopped)
    found.warnings.push_back("the fit was stopped before it converged: " + earlier.message);
  return write_parity(held, options, {campaign, found, reasons, false_alarm, provenance});
}

}  // namespace

Run add_parity(CLI::App& verb) {
  const auto options = std::make_shared<ParityRequest>();
  add_campaign_options(verb, options->common);
  verb.add_option("--fit", options->fit, "fit.json of a fit to healthy records of the rig");
  verb.add_option("--false-alarms", options->false_alarm_percent,
                  "percentage of healthy records that raise an alarm (default 1)");
  verb.add_option("--healthy", options->healthy,
                  "leak level that is healthy, besides those that the campaign knows; repeatable");
  return [options](const Invocation& invocation) { return run_parity(*options, invocation); };
}

}  // namespace rigcal::app
