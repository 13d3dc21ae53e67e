#include <optional>

#include "calib/trust/plan.hpp"
#include "datasets/prepare/load_record.hpp"
#include "datasets/prepare/time_holes.hpp"
#include "report/job/job.hpp"
#include "report/page/page_plan.hpp"
#include "report/store/plan.hpp"

namespace rigcal::report {

JobResult plan_job(const datasets::Campaign& campaign, const FitSource& fit,
                   const JobTerms& terms) {
  std::optional<EarlierFit> earlier;
  if (fit.given()) earlier = fit.read(campaign.rig.plant);
  std::vector<datasets::Record> records;
  for (const datasets::Condition& condition : campaign.conditions) {
    const bool taken =
        condition.use == datasets::Use::fit || condition.use == datasets::Use::validate;
    if (!taken || !condition.has_record()) continue;
    records.push_back(datasets::load_record(campaign, condition));
    datasets::require_no_holes(campaign, records.back());
  }
  terms.hold({{"plan.json", "report.html"}, {}});
  const Provenance provenance{terms.command, 1, terms.options,
                              hash_inputs(campaign, records, fit.inputs())};
  const calib::Plan plan =
      calib::plan(campaign, records, earlier ? &earlier->values : nullptr, terms.threads);
  const StoredPlan result = stored(campaign, plan, provenance);
  JobResult job;
  job.json = json_of(result);
  job.files = {{"plan.json", json_text(job.json)}};
  job.first = {"plan.json"};
  job.verdict = plan_headline(result);
  job.sections = plan_sections(result);
  job.inputs = provenance.inputs;
  return job;
}

}  // namespace rigcal::report
