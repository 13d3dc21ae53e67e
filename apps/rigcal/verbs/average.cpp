#include <fmt/format.h>

#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/verb.hpp"
#include "report/run/averaging.hpp"
#include "report/store/folder.hpp"
#include "report/text/repeatability_text.hpp"

namespace rigcal::app {
namespace {

ExitCode run_average(const CampaignOptions& options, const Invocation& invocation) {
  const datasets::Campaign campaign = load(options);
  report::HeldFolder held(options.out, holding("average", options.force, options.print));
  held.plan(report::planned_average(campaign));
  const std::vector<datasets::Record> records = report::averaged_records(campaign);
  const report::StoredAverage average = report::write_average(
      held, options.threads, campaign, records, {invocation.command, 1, recorded(options), {}});
  std::string text = report::repeatability_text(campaign, records, terminal_style());
  text +=
      fmt::format("files: {} {} {} {}\n", (options.out / "average.json").string(),
                  (options.out / "repeatability.csv").string(),
                  (options.out / "averaged" / "").string(), (options.out / "report.html").string());
  print(options.print, text, report::json_of(average));
  return ExitCode::done;
}

}  // namespace

Run add_average(CLI::App& verb) {
  const auto options = std::make_shared<CampaignOptions>();
  add_campaign_options(verb, *options);
  return [options](const Invocation& invocation) { return run_average(*options, invocation); };
}

}  // namespace rigcal::app
