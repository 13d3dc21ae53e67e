#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "datasets/campaign/reading_root.hpp"
#include "datasets/checks/record_warnings.hpp"
#include "datasets/prepare/single_repeats.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/record/obstacles.hpp"
#include "report/job/job.hpp"
#include "report/job/leak_records.hpp"
#include "report/leak/diagnosis.hpp"
#include "report/leak/read_leak_table.hpp"
#include "report/live/live_fit.hpp"
#include "report/page/page_parts.hpp"
#include "report/store/result_files.hpp"
#include "report/store/validity.hpp"

namespace rigcal::report {
namespace {

using datasets::Campaign;
using datasets::Condition;

/// Warns about records outside the range covered by the fit. The check uses the leak that was
/// found.
void warn_of_validity(const Campaign& campaign, const calib::Validity& covered,
                      diagnosis::Diagnosis& found) {
  const int leak = model::parameter_index(campaign.rig.plant,
                                          datasets::leak_parameter(campaign.diagnosis.leak_law));
  for (diagnosis::RecordDiagnosis& record : found.records) {
    if (!record.fit.ok()) continue;
    Campaign alone = campaign;
    std::erase_if(alone.conditions, [&](const Condition& c) { return c.id != record.condition; });
    calib::Fit values;
    calib::FittedParameter& own = values.parameters.emplace_back(calib::parameter_in_row(
        campaign.rig.plant, leak, datasets::Scope::condition, record.condition));
    own.value = std::max(0.0, record.estimate.coefficient);
    own.fitted = true;
    calib::Validity asked = calib::coverage(alone, {}, values, {alone.conditions.front().use});
    // The leak is the unknown here, and a fit to healthy records does not cover any leak.
    asked.leakage_coefficient.reset();
    for (const std::string& text : outside(asked, covered)) record.warnings.push_back(text);
  }
}

/// Warns about doubtful recordings. A doubt about a single average is shown with it; a doubt about
/// several is shown once for all.
void warn_of_recordings(const std::vector<datasets::Record>& averages,
                        diagnosis::Diagnosis& found) {
  for (const auto& warning : gathered_doubts(averages)) {
    if (warning.conditions.size() > 1) {
      found.warnings.push_back(warning.with_conditions());
      continue;
    }
    for (diagnosis::RecordDiagnosis& record : found.records)
      if (!record.repeat && record.condition == warning.conditions.front())
        record.warnings.push_back("recording: " + warning.text);
  }
}

/// Takes the class limits from the rows of a leak table, which must describe the same rig as this
/// diagnosis.
std::vector<diagnosis::LeakEntry> take_table(const std::filesystem::path& file,
                                             const EarlierFit& earlier, Campaign& campaign) {
  if (campaign.diagnosis.leak_law != datasets::LeakLaw::orifice)
    throw InputError(
        {campaign.file.string()},
        fmt::format("diagnosis.leak_law: \"{}\" with the leak table {}: its "
                    "coefficients apply to an orifice; expected \"orifice\" or no --table",
                    to_string(campaign.diagnosis.leak_law), file.string()));
  const EarlierLeakTable table = read_leak_table(file, campaign.rig.plant);
  const auto differences = rig_differences(table, campaign, earlier.values);
  if (!differences.empty()) {
    throw InputError(
        {file.string()},
        fmt::format("the table belongs to another rig: {}; expected that of leak-table "
                    "--fit with the same campaign and fit.json",
                    fmt::join(differences, "; ")));
  }
  diagnosis::take_limits(campaign.diagnosis, table.targets_percent, file.string());
  return table.limits;
}

/// Warns about diagnosed signals for which the leak table has no column.
void warn_of_absent(const std::vector<diagnosis::LeakEntry>& limits, const Campaign& campaign,
                    diagnosis::Diagnosis& found) {
  std::vector<std::string> absent;
  for (const diagnosis::RecordDiagnosis& record : found.records) {
    const Condition& condition = *campaign.find(record.condition);
    const bool is_there = std::any_of(limits.begin(), limits.end(), [&](const auto& limit) {
      return limit.drive.waveform == condition.waveform &&
             limit.drive.frequency_hz == condition.frequency_hz &&
             limit.drive.amplitude() == condition.amplitude;
    });
    if (!is_there && std::find(absent.begin(), absent.end(), record.signal) == absent.end())
      absent.push_back(record.signal);
  }
  if (!absent.empty())
    found.warnings.push_back(
        fmt::format("the leak table has no column for {}: its classes follow from the share alone",
                    fmt::join(absent, "; ")));
}

/// Warns about doubts that the fit itself reported, because they apply to every leak based on the
/// fit.
void warn_of_fit(const EarlierFit& fit, diagnosis::Diagnosis& found) {
  if (fit.status == calib::FitStatus::stopped)
    found.warnings.push_back("the fit was stopped before it converged: " + fit.message);
  for (const calib::Aspect* aspect : {&fit.adequacy, &fit.parameters}) {
    if (aspect->state == calib::AspectState::pass) continue;
    for (const calib::Reason& reason : aspect->reasons)
      if (calib::is_against(reason.state))
        found.warnings.push_back("from the fit: " + reason.words);
  }
}

std::optional<std::vector<datasets::FittedValue>> truth_beside(const Campaign& campaign) {
  const auto file = campaign.file.parent_path() / "truth.json";
  std::error_code error;
  if (!campaign.synthetic || !std::filesystem::exists(file, error)) return std::nullopt;
  datasets::require_within(campaign.root, file);
  try {
    return read_truth(file, campaign.rig.plant);
  } catch (const InputError&) {
    // A link may lead to any file.
    if (datasets::lies_within(campaign.file.parent_path(), file)) throw;
    throw InputError(
        {file.string()},
        "is not a truth.json that synthesize wrote. The content of the file is not shown, because "
        "a link leads out of the campaign's folder; expected the truth.json of this campaign");
  }
}

/// @param live  contents of diagnosis_live.json, if the rig can be simulated in the page
JobResult finished(StoredDiagnosis diagnosis, const Provenance& provenance,
                   const std::optional<Json>& live = {}) {
  JobResult job;
  job.code = diagnosis.status == LeakStatus::done ? ExitCode::done : ExitCode::no_result;
  job.files = {{"diagnosis.csv", diagnosis_csv(diagnosis)}};
  if (live) job.files.push_back(json_file(kLiveDiagnosisFile, *live, json_line));
  name_files(job.files, diagnosis.provenance);
  job.files.push_back(json_file("diagnosis.json", std::move(diagnosis)));
  job.first = {"diagnosis.json", "diagnosis.csv"};
  job.inputs = provenance.inputs;
  return job;
}

}  // namespace

JobResult diagnosis_job(Campaign campaign, const DiagnosisRequest& request, const JobTerms& terms) {
  take_healthy(request.healthy, campaign);
  const std::vector<std::string> reasons = diagnosis::obstacles(campaign, request.fit.given());
  std::vector<std::filesystem::path> more_inputs = request.fit.inputs();
  if (!request.table.empty()) more_inputs.push_back(request.table);
  Provenance provenance{terms.command, 0, terms.options, {}};
  for (const std::string& level : request.healthy)
    provenance.options.emplace_back("healthy", level);
  if (!request.fit.given() && diagnosis::obstacles(campaign, true).empty()) {
    throw UsageError(
        "diagnose: --fit is missing: expected the fit.json of a fit to healthy records");
  }
  terms.hold({{"diagnosis.json", "diagnosis.csv", kLiveDiagnosisFile, "report.html"}, {}});
  diagnosis::Diagnosis found;
  if (!reasons.empty()) {
    provenance.inputs = hash_inputs(campaign, {}, more_inputs);
    found.settings = diagnosis::stated(campaign.diagnosis);
    return finished(stored(campaign, found, reasons, provenance), provenance);
  }
  const EarlierFit earlier = request.fit.read(campaign.rig.plant);
  std::vector<diagnosis::LeakEntry> limits;
  if (!request.table.empty()) limits = take_table(request.table, earlier, campaign);
  diagnosis::DiagnosisOptions settings;
  settings.threads = terms.threads;
  settings.cancel = &terms.cancel;
  settings.truth = truth_beside(campaign);
  settings.progress = [&](int done, int all) { terms.progress("records", done, all); };
  const LeakRecords records = load_leak_records(campaign, settings.threads);
  provenance.inputs = hash_inputs(campaign, records.averages(), more_inputs);
  diagnosis::RigFit rig{earlier.values, earlier.indices, earlier.covariance};
  if (earlier.joint) rig.consider(*earlier.joint, campaign.diagnosis.leak_law);
  found = diagnosis::diagnose(campaign, records.conditions, rig, settings);
  found.warnings.insert(found.warnings.end(), records.left_out.begin(), records.left_out.end());
  warn_of_validity(campaign, earlier.validity, found);
  warn_of_recordings(records.averages(), found);
  found.class_limits = diagnosis::class_limits(campaign, limits);
  if (!limits.empty()) warn_of_absent(limits, campaign, found);
  warn_of_fit(earlier, found);
  const auto live = live_diagnosis(campaign, records.averages(), earlier.values, found);
  return finished(stored(campaign, found, reasons, provenance), provenance, live);
}

}  // namespace rigcal::report
