#include "calib/published/fit_tables.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "apps/rigcal/interrupt.hpp"
#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/verb.hpp"
#include "report/job/leak_table_files.hpp"
#include "report/leak/fit_tables.hpp"
#include "report/page/page_parts.hpp"
#include "report/run/result_page.hpp"
#include "report/store/folder.hpp"
#include "report/store/json.hpp"
#include "report/store/parameters_csv.hpp"

namespace rigcal::app {
namespace {

using calib::FitStatus;

ExitCode run_fit_tables(const CampaignOptions& options, const Invocation& invocation) {
  const report::LeakTableInput input = report::load_leak_table(options);
  const Kept kept;
  report::HeldFolder held(options.out, holding("fit-tables", options.force, options.print));
  // If the fit does not converge, the tables of an earlier run are removed: they would contradict
  // this one.
  report::PlannedFiles planned = report::planned_leak_table(input.settings);
  for (const char* file : {"fit.json", "parameters.csv", "fitted.toml"})
    planned.files.emplace_back(file);
  held.plan(std::move(planned));
  const calib::LeakTableOptions settings =
      report::leak_table_options(input.campaign, options.threads, invocation.cancel);
  const calib::TablesFit fit = calib::fit_tables(input.campaign, input.settings, settings);

  report::Provenance provenance;
  provenance.command = invocation.command;
  provenance.options = recorded(options);
  provenance.inputs = report::hash_inputs(input.campaign, {});
  const report::TablesFitResult result{input.campaign, fit, provenance};
  std::string text = report::tables_fit_text(result, terminal_style());
  std::vector<report::ResultFile> files;
  if (fit.status == FitStatus::converged) {
    const calib::LeakTable table = calib::leak_table(input.campaign, fit.settings, settings);
    const report::LeakTableResult tables{input.campaign, fit.settings, table, provenance};
    files = report::leak_table_files(tables);
    const report::LeakTableFiles stored{report::stored(tables), {}};
    text = text_of({report::leak_table_headline(stored), report::leak_table_sections(stored)},
                   options.print) +
           "\n" + text;
    files.push_back(
        {"fitted.toml", fitted_leak_table_text(input.campaign, fit.settings, options.out)});
  }
  const report::StoredTablesFit stored = report::stored(result);
  const report::Json json = report::json_of(stored);
  files.push_back(
      {"parameters.csv", report::parameters_csv(stored.status, stored.message, stored.parameters)});
  files.push_back({"fit.json", report::json_text(json)});
  add_page(options.out, options.threads, files);
  report::write_results(held, files, provenance.inputs);
  print(options.print, text + fmt::format("files: {}\n", (options.out / "fit.json").string()),
        json);
  if (fit.status == FitStatus::failed) return ExitCode::no_result;
  return fit.status == FitStatus::stopped ? ExitCode::stopped : ExitCode::done;
}

}  // namespace

Run add_fit_tables(CLI::App& verb) {
  const auto options = std::make_shared<CampaignOptions>();
  add_campaign_options(verb, *options);
  return [options](const Invocation& invocation) { return run_fit_tables(*options, invocation); };
}

}  // namespace rigcal::app
