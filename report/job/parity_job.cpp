#include <fmt/format.h>

#include "diagnosis/parity/parity.hpp"
#include "diagnosis/record/obstacles.hpp"
#include "report/job/job.hpp"
#include "report/job/leak_records.hpp"
#include "report/leak/parity.hpp"
#include "report/page/page_parts.hpp"
#include "report/store/result_files.hpp"

namespace rigcal::report {
namespace {

JobResult finished(StoredParity parity, std::vector<ResultFile> series,
                   const Provenance& provenance) {
  JobResult job;
  job.code = parity.status == LeakStatus::done ? ExitCode::done : ExitCode::no_result;
  job.files = std::move(series);
  job.files.push_back({"parity.csv", parity_csv(parity)});
  name_files(job.files, parity.provenance);
  job.files.push_back(json_file("parity.json", std::move(parity)));
  job.first = {"parity.json", "parity.csv", "parity/"};
  job.inputs = provenance.inputs;
  return job;
}

}  // namespace

JobResult parity_job(datasets::Campaign campaign, const ParityRequest& request,
                     const JobTerms& terms) {
  take_healthy(request.healthy, campaign);
  if (!request.fit.given())
    throw UsageError("parity: --fit is missing: expected the fit.json of a fit to healthy records");
  const double false_alarm = request.false_alarm_percent / 100.0;
  if (!(false_alarm > 0.0 && false_alarm < 0.5)) {
    throw UsageError(fmt::format("--false-alarms {:g}: expected a percentage above 0 and below 50",
                                 request.false_alarm_percent));
  }
  const std::vector<std::string> reasons = diagnosis::obstacles(campaign, true);
  Provenance provenance{terms.command, 0, terms.options, {}};
  provenance.options.emplace_back("false_alarms_percent",
                                  fmt::format("{:g}", request.false_alarm_percent));
  for (const std::string& level : request.healthy)
    provenance.options.emplace_back("healthy", level);
  terms.hold(planned_parity(campaign));
  diagnosis::Parity found;
  if (!reasons.empty()) {
    provenance.inputs = hash_inputs(campaign, {}, request.fit.inputs());
    return finished(stored(campaign, found, reasons, false_alarm, provenance), {}, provenance);
  }
  const EarlierFit earlier = request.fit.read(campaign.rig.plant);
  const LeakRecords records = load_leak_records(campaign, terms.threads);
  provenance.inputs = hash_inputs(campaign, records.averages(), request.fit.inputs());
  diagnosis::ParityOptions settings;
  settings.false_alarm = false_alarm;
  settings.threads = terms.threads;
  settings.cancel = &terms.cancel;
  settings.progress = [&](int done, int all) { terms.progress("conditions", done, all); };
  found = diagnosis::parity(campaign, records.conditions,
                            {earlier.values, earlier.indices, earlier.covariance}, settings);
  found.warnings.insert(found.warnings.end(), records.left_out.begin(), records.left_out.end());
  for (const auto& warning : gathered_doubts(records.averages()))
    found.warnings.push_back(warning.with_conditions());
  if (earlier.status == calib::FitStatus::stopped)
    found.warnings.push_back("the fit was stopped before it converged: " + earlier.message);
  return finished(stored(campaign, found, reasons, false_alarm, provenance), parity_series(found),
                  provenance);
}

}  // namespace rigcal::report
