#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/verb.hpp"
#include "report/page/page_average.hpp"
#include "report/run/averaging.hpp"
#include "report/store/folder.hpp"

namespace rigcal::app {
namespace {

ExitCode run_average(const CampaignOptions& options, const Invocation& invocation) {
  const datasets::Campaign campaign = load(options);
  report::HeldFolder held(options.out, holding("average", options.force, options.print));
  held.plan(report::planned_average(campaign));
  const std::vector<datasets::Record> records = report::averaged_records(campaign);
  report::AverageFiles stored{report::write_average(held, options.threads, campaign, records,
                                                    {invocation.command, 1, recorded(options), {}}),
                              {}};
  stored.series.resize(stored.result.records.size());
  print(options.print,
        {report::average_headline(stored), report::average_sections(stored), campaign.synthetic},
        options.out, {"average.json", "repeatability.csv", "averaged/", "report.html"},
        report::json_of(stored.result));
  return ExitCode::done;
}

}  // namespace

Run add_average(CLI::App& verb) {
  const auto options = std::make_shared<CampaignOptions>();
  add_campaign_options(verb, *options);
  return [options](const Invocation& invocation) { return run_average(*options, invocation); };
}

}  // namespace rigcal::app
