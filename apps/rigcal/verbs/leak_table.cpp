#include "calib/published/leak_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include "apps/rigcal/fitted_rig.hpp"
#include "apps/rigcal/leak_table_files.hpp"
#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/verb.hpp"
#include "report/leak/leak_table.hpp"
#include "report/page/page_parts.hpp"
#include "report/run/result_page.hpp"
#include "report/store/folder.hpp"

namespace rigcal::app {
namespace {

struct LeakTableRequest {
  CampaignOptions common;
  std::vector<double> targets_percent;
  std::vector<std::string> signals;
  std::filesystem::path fit;
};

void choose_targets(const LeakTableRequest& options, datasets::LeakTableSettings& settings) {
  if (options.targets_percent.empty()) return;
  settings.targets_percent = options.targets_percent;
  std::sort(settings.targets_percent.begin(), settings.targets_percent.end());
  const auto last = std::unique(settings.targets_percent.begin(), settings.targets_percent.end());
  settings.targets_percent.erase(last, settings.targets_percent.end());
}

void choose_signals(const LeakTableRequest& options, const datasets::Campaign& campaign,
                    datasets::LeakTableSettings& settings) {
  if (options.signals.empty()) return;
  std::vector<datasets::LeakSignal> chosen;
  for (const std::string& text : options.signals) {
    chosen.push_back(signal_from_text(campaign, settings, text));
  }
  settings.signals = std::move(chosen);
}

ExitCode run_leak_table(const LeakTableRequest& options, const Invocation& invocation) {
  LeakTableInput input = load_leak_table(options.common);
  FittedRig rig;
  std::vector<std::filesystem::path> more_inputs;
  if (options.fit.empty()) {
    rig.warnings = replaced_by_assumptions(input);
  } else {
    more_inputs.push_back(options.fit);
    rig = take_fit(input, report::read_fit(options.fit, input.campaign.rig.plant),
                   options.common.set);
  }
  choose_targets(options, input.settings);
  choose_signals(options, input.campaign, input.settings);
  report::HeldFolder held(options.common.out,
                          holding("leak-table", options.common.force, options.common.print));
  held.plan(planned_leak_table(input.settings));
  calib::LeakTableOptions settings = leak_table_options(options.common, input.campaign, invocation);
  settings.rig = rig.uncertainty;
  const calib::LeakTable table = calib::leak_table(input.campaign, input.settings, settings);
  report::Provenance provenance;
  provenance.command = invocation.command;
  provenance.options = recorded(options.common);
  provenance.options.emplace_back("targets",
                                  fmt::format("{}", fmt::join(options.targets_percent, ",")));
  provenance.options.emplace_back("signals", fmt::format("{}", fmt::join(options.signals, ",")));
  provenance.inputs = report::hash_inputs(input.campaign, {}, more_inputs);
  const report::LeakTableResult result{input.campaign, input.settings, table,
                                       provenance,     rig.notes,      rig.warnings};
  auto files = leak_table_files(result);
  add_page(options.common.out, options.common.threads, files);
  report::write_results(held, files, provenance.inputs);
  const report::LeakTableFiles stored{report::stored(result), {}};
  print(options.common.print,
        {report::leak_table_headline(stored), report::leak_table_sections(stored)},
        options.common.out, {"leak_table.csv", "leak_table.json", "report.html"},
        report::json_of(stored.result));
  return ExitCode::done;
}

}  // namespace

Run add_leak_table(CLI::App& verb) {
  const auto options = std::make_shared<LeakTableRequest>();
  add_campaign_options(verb, options->common);
  verb.add_option("--fit", options->fit,
                  "fit.json of a fit of the rig: its values, with intervals of the coefficients")
      ->check(not_empty());
  verb.add_option("--targets", options->targets_percent,
                  "Shares of the servo flow in percent: 5,15,25 (default: the campaign's)")
      ->delimiter(',')
      ->check(CLI::Range(1e-3, 1000.0))
      ->allow_extra_args(false);
  verb.add_option("--signals", options->signals,
                  "Drives: sine@0.1Hz,square@10Hz@20mm (default: the campaign's)")
      ->delimiter(',')
      ->allow_extra_args(false);
  return [options](const Invocation& invocation) { return run_leak_table(*options, invocation); };
}

}  // namespace rigcal::app
