#include "diagnosis/table/fit_tables.hpp"
#include "report/job/job.hpp"
#include "report/job/leak_table_files.hpp"
#include "report/store/csv.hpp"
#include "report/store/result_files.hpp"
#include "report/store/stored/stored_tables_fit.hpp"

namespace rigcal::report {

using calib::FitStatus;

JobResult fit_tables_job(const CampaignChoice& choice, const JobTerms& terms) {
  const LeakTableInput input = load_leak_table(choice);
  // If the fit does not converge, tables left by an earlier run are removed, because they would
  // contradict this run.
  PlannedFiles planned = planned_leak_table(input.settings);
  for (const char* file : {"fit.json", "parameters.csv", "fitted.toml"})
    planned.files.emplace_back(file);
  terms.hold(std::move(planned));
  const diagnosis::LeakTableOptions settings =
      leak_table_options(input.campaign, terms.threads, terms.cancel);
  const diagnosis::TablesFit fit = diagnosis::fit_tables(input.campaign, input.settings, settings);
  const Provenance provenance{terms.command, 1, terms.options, hash_inputs(input.campaign, {})};
  JobResult job;
  if (fit.status == FitStatus::converged) {
    job.files =
        leak_table_files(input.campaign, fit.settings,
                         stored(diagnosis::leak_table(input.campaign, fit.settings, settings),
                                input.campaign, provenance));
    job.files.push_back(
        {"fitted.toml", fitted_leak_table_text(input.campaign, fit.settings, terms.out)});
  }
  StoredTablesFit result;
  static_cast<diagnosis::TablesFit&>(result) = fit;
  result.campaign = input.campaign.name;
  result.provenance = stored(provenance);
  job.files.push_back(
      {"parameters.csv", parameters_csv(result.status, result.message, result.parameters)});
  job.files.push_back(json_file("fit.json", std::move(result)));
  job.first = {"fit.json"};
  job.inputs = provenance.inputs;
  job.code = fit.status == FitStatus::failed    ? ExitCode::no_result
             : fit.status == FitStatus::stopped ? ExitCode::stopped
                                                : ExitCode::done;
  return job;
}

}  // namespace rigcal::report
