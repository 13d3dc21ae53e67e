#include <cmath>

#include "calib/published/fit_tables.hpp"
#include "calib/trust/identifiability.hpp"
#include "report/job/job.hpp"
#include "report/job/leak_table_files.hpp"
#include "report/store/json.hpp"
#include "report/store/parameters_csv.hpp"
#include "report/store/stored/stored_tables_fit.hpp"

namespace rigcal::report {
namespace {

using calib::FitStatus;

std::string reason(const calib::FittedAssumption& p) {
  if (p.at_bound) return "at its bound";
  if (!p.standard_error || !p.ci95) return "the published numbers do not determine it";
  if (p.identifiability == calib::Identifiability::identified) return "";
  if (p.identifiability == calib::Identifiability::bounded)
    return "not significantly different from zero";
  const double half_width = 0.5 * (p.ci95->high - p.ci95->low);
  return calib::half_width_words(half_width / std::abs(p.value));
}

calib::FittedParameter stored(const datasets::Campaign& campaign, FitStatus status,
                              const calib::FittedAssumption& p) {
  const auto& spec = datasets::assumption_spec(campaign.rig.plant, p.index);
  calib::FittedParameter parameter;
  parameter.name_after(spec);
  parameter.value = status != FitStatus::failed ? p.value : std::nan("");
  parameter.start = p.start;
  parameter.lower = p.lower;
  parameter.upper = p.upper;
  parameter.fitted = true;
  parameter.standard_error = p.standard_error;
  if (p.ci95) {
    parameter.ci95 = *p.ci95;
    parameter.ci95_if_exact = parameter.ci95;
    parameter.ci95_from = std::optional(calib::IntervalSource::standard_error);
    parameter.degrees_of_freedom = p.degrees_of_freedom;
  }
  parameter.at_bound = p.at_bound;
  parameter.identifiability = p.identifiability;
  parameter.reason = reason(p);
  return parameter;
}

StoredTablesFit stored(const datasets::Campaign& campaign, const calib::TablesFit& fit,
                       const Provenance& provenance) {
  const bool failed = fit.status == FitStatus::failed;
  StoredTablesFit json;
  json.status = fit.status;
  json.message = fit.message;
  json.campaign = campaign.name;
  if (!failed) json.cost = fit.cost;
  json.residual_count = static_cast<long>(fit.residuals.size());
  if (!failed) json.rms = fit.rms;
  json.evaluations = fit.evaluations;
  json.iterations = fit.iterations;
  json.wall_seconds = fit.wall_seconds;
  for (const calib::FittedAssumption& p : fit.parameters)
    json.parameters.push_back(stored(campaign, fit.status, p));
  json.correlation = fit.correlation;
  json.residuals = fit.residuals;
  json.left_out = fit.left_out;
  json.provenance = report::stored(provenance);
  return json;
}

}  // namespace

JobResult fit_tables_job(const CampaignChoice& choice, const JobTerms& terms) {
  const LeakTableInput input = load_leak_table(choice);
  // If the fit does not converge, tables left by an earlier run are removed, because they would
  // contradict this run.
  PlannedFiles planned = planned_leak_table(input.settings);
  for (const char* file : {"fit.json", "parameters.csv", "fitted.toml"})
    planned.files.emplace_back(file);
  terms.hold(std::move(planned));
  const calib::LeakTableOptions settings =
      leak_table_options(input.campaign, terms.threads, terms.cancel);
  const calib::TablesFit fit = calib::fit_tables(input.campaign, input.settings, settings);
  const Provenance provenance{terms.command, 1, terms.options, hash_inputs(input.campaign, {})};
  JobResult job;
  if (fit.status == FitStatus::converged) {
    const calib::LeakTable table = calib::leak_table(input.campaign, fit.settings, settings);
    job.files = leak_table_files({input.campaign, fit.settings, table, provenance});
    job.files.push_back(
        {"fitted.toml", fitted_leak_table_text(input.campaign, fit.settings, terms.out)});
  }
  const StoredTablesFit result = stored(input.campaign, fit, provenance);
  job.files.push_back(
      {"parameters.csv", parameters_csv(result.status, result.message, result.parameters)});
  job.files.push_back({"fit.json", json_text(json_of(result))});
  job.first = {"fit.json"};
  job.inputs = provenance.inputs;
  job.code = fit.status == FitStatus::failed    ? ExitCode::no_result
             : fit.status == FitStatus::stopped ? ExitCode::stopped
                                                : ExitCode::done;
  return job;
}

}  // namespace rigcal::report
