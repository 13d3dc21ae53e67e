#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "calib/published/leak_table.hpp"
#include "report/job/fitted_rig.hpp"
#include "report/job/job.hpp"
#include "report/job/leak_table_files.hpp"
#include "report/leak/leak_table.hpp"
#include "report/page/page_parts.hpp"

namespace rigcal::report {
namespace {

void choose_targets(const LeakTableRequest& request, datasets::LeakTableSettings& settings) {
  if (request.targets_percent.empty()) return;
  settings.targets_percent = request.targets_percent;
  std::sort(settings.targets_percent.begin(), settings.targets_percent.end());
  const auto last = std::unique(settings.targets_percent.begin(), settings.targets_percent.end());
  settings.targets_percent.erase(last, settings.targets_percent.end());
}

void choose_signals(const LeakTableRequest& request, const datasets::Campaign& campaign,
                    datasets::LeakTableSettings& settings) {
  if (request.signals.empty()) return;
  std::vector<datasets::LeakSignal> chosen;
  for (const std::string& text : request.signals) {
    chosen.push_back(signal_from_text(campaign, settings, text));
  }
  settings.signals = std::move(chosen);
}

}  // namespace

JobResult leak_table_job(const CampaignChoice& choice, const LeakTableRequest& request,
                         const JobTerms& terms) {
  LeakTableInput input = load_leak_table(choice);
  FittedRig rig;
  if (request.fit.given()) {
    rig = take_fit(input, request.fit.read(input.campaign.rig.plant), choice.set);
  } else {
    rig.warnings = replaced_by_assumptions(input);
  }
  choose_targets(request, input.settings);
  choose_signals(request, input.campaign, input.settings);
  terms.hold(planned_leak_table(input.settings));
  calib::LeakTableOptions settings =
      leak_table_options(input.campaign, terms.threads, terms.cancel);
  settings.rig = rig.uncertainty;
  const calib::LeakTable table = calib::leak_table(input.campaign, input.settings, settings);
  Provenance provenance;
  provenance.command = terms.command;
  provenance.options = terms.options;
  provenance.options.emplace_back("targets",
                                  fmt::format("{}", fmt::join(request.targets_percent, ",")));
  provenance.options.emplace_back("signals", fmt::format("{}", fmt::join(request.signals, ",")));
  provenance.inputs = hash_inputs(input.campaign, {}, request.fit.inputs());
  const LeakTableResult result{input.campaign, input.settings, table,
                               provenance,     rig.notes,      rig.warnings};
  JobResult job;
  job.files = leak_table_files(result);
  job.first = {"leak_table.csv", "leak_table.json"};
  job.inputs = provenance.inputs;
  return job;
}

}  // namespace rigcal::report
