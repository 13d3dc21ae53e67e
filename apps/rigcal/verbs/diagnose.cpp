#include "diagnosis/diagnose.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <memory>

#include "apps/rigcal/leak_records.hpp"
#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/progress.hpp"
#include "apps/rigcal/verb.hpp"
#include "datasets/campaign/reading_root.hpp"
#include "datasets/checks/record_warnings.hpp"
#include "datasets/prepare/single_repeats.hpp"
#include "diagnosis/obstacles.hpp"
#include "report/leak/diagnosis.hpp"
#include "report/page/page_parts.hpp"
#include "report/run/result_page.hpp"
#include "report/store/folder.hpp"
#include "report/store/json.hpp"
#include "report/store/validity.hpp"

namespace rigcal::app {
namespace {

using datasets::Campaign;
using datasets::Condition;

struct DiagnoseRequest {
  CampaignOptions common;
  std::filesystem::path fit;
  std::filesystem::path table;
  std::vector<std::string> healthy;
};

/// Warns of records outside the range of the fit, which is checked with the leak that was found.
void warn_of_validity(const Campaign& campaign, const report::Validity& covered,
                      diagnosis::Diagnosis& found) {
  const int leak = model::parameter_index(campaign.rig.plant, "leakage_coefficient");
  for (diagnosis::RecordDiagnosis& record : found.records) {
    if (!record.fit.ok()) continue;
    Campaign alone = campaign;
    std::erase_if(alone.conditions, [&](const Condition& c) { return c.id != record.condition; });
    calib::Fit values;
    calib::FittedParameter& own = values.parameters.emplace_back();
    own.index = leak;
    own.scope = datasets::Scope::condition;
    own.level = record.condition;
    own.value = std::max(0.0, record.estimate.coefficient);
    own.fitted = true;
    report::Validity asked = report::coverage(alone, {}, values, {alone.conditions.front().use});
    // The leak is the unknown here, and a fit to healthy records covers none.
    asked.leakage_coefficient.reset();
    for (const std::string& text : report::outside(asked, covered)) record.warnings.push_back(text);
  }
}

/// Warns of doubtful recordings: beside the average of a single one, or once for many.
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

/// The classes end where the rows of a leak table do, which must be that of the rig diagnosed here.
std::vector<report::TableLimit> take_table(const std::filesystem::path& file,
                                           const report::EarlierFit& earlier, Campaign& campaign) {
  const report::EarlierLeakTable table = report::read_leak_table(file, campaign.rig.plant);
  const auto differences = report::rig_differences(table, campaign, earlier.values);
  if (!differences.empty()) {
    throw InputError({file.string()},
                     fmt::format("the table is of another rig: {}; expected that of leak-table "
                                 "--fit with the same campaign and fit.json",
                                 fmt::join(differences, "; ")));
  }
  report::take_limits(campaign.diagnosis, table.targets_percent, file.string());
  return table.limits;
}

/// Signals that were diagnosed and are no column of the table.
void warn_of_absent(const std::vector<report::TableLimit>& limits, const Campaign& campaign,
                    diagnosis::Diagnosis& found) {
  std::vector<std::string> absent;
  for (const diagnosis::RecordDiagnosis& record : found.records) {
    const Condition& condition = *campaign.find(record.condition);
    const bool is_there = std::any_of(limits.begin(), limits.end(), [&](const auto& limit) {
      return limit.waveform == condition.waveform && limit.frequency_hz == condition.frequency_hz &&
             limit.amplitude == condition.amplitude;
    });
    if (!is_there && std::find(absent.begin(), absent.end(), record.signal) == absent.end())
      absent.push_back(record.signal);
  }
  if (!absent.empty())
    found.warnings.push_back(
        fmt::format("the leak table has no column for {}: its classes are by the share alone",
                    fmt::join(absent, "; ")));
}

/// Doubts of the fit about itself apply to every leak that is based on it.
void warn_of_fit(const report::EarlierFit& fit, diagnosis::Diagnosis& found) {
  if (fit.status == calib::FitStatus::stopped)
    found.warnings.push_back("the fit was stopped before it converged: " + fit.message);
  for (const calib::Aspect* aspect : {&fit.adequacy, &fit.parameters}) {
    if (aspect->state == calib::AspectState::pass) continue;
    for (const calib::Reason& reason : aspect->reasons)
      if (calib::is_against(reason.state))
        found.warnings.push_back("the fit that this rests on: " + reason.words);
  }
}

std::optional<std::vector<datasets::FittedValue>> truth_beside(const Campaign& campaign) {
  const auto file = campaign.file.parent_path() / "truth.json";
  std::error_code error;
  if (!campaign.synthetic || !std::filesystem::exists(file, error)) return std::nullopt;
  datasets::require_within(campaign.root, file);
  return report::read_truth(file, campaign.rig.plant);
}

ExitCode write_diagnosis(report::HeldFolder& held, const DiagnoseRequest& options,
                         const report::DiagnosisResult& result) {
  const report::StoredDiagnosis stored = report::stored(result);
  const report::Json json = report::json_of(stored);
  std::vector<report::ResultFile> files{{"diagnosis.csv", report::diagnosis_csv(result)},
                                        {"diagnosis.json", report::json_text(json)}};
  add_page(options.common.out, options.common.threads, files);
  report::write_results(held, files, result.provenance.inputs);
  print(options.common.print,
        {report::diagnosis_headline(stored), report::diagnosis_sections(stored), stored.synthetic},
        options.common.out, {"diagnosis.json", "diagnosis.csv", "report.html"}, json);
  return report::status_of(result) == report::LeakStatus::done ? ExitCode::done
                                                               : ExitCode::no_result;
}

ExitCode run_diagnose(const DiagnoseRequest& options, const Invocation& invocation) {
  Campaign campaign = load(options.common);
  take_healthy(options.healthy, campaign);
  const bool has_fit = !options.fit.empty();
  const std::vector<std::string> reasons = diagnosis::obstacles(campaign, has_fit);
  std::vector<std::filesystem::path> more_inputs;
  if (has_fit) more_inputs.push_back(options.fit);
  if (!options.table.empty()) more_inputs.push_back(options.table);
  report::Provenance provenance{invocation.command, 0, recorded(options.common), {}};
  for (const std::string& level : options.healthy)
    provenance.options.emplace_back("healthy", level);
  if (!has_fit && diagnosis::obstacles(campaign, true).empty()) {
    throw UsageError(
        "diagnose: --fit is missing: expected the fit.json of a fit to healthy records");
  }
  report::HeldFolder held(options.common.out,
                          holding("diagnose", options.common.force, options.common.print));
  held.plan({{"diagnosis.json", "diagnosis.csv", "report.html"}, {}});
  diagnosis::Diagnosis found;
  if (!reasons.empty()) {
    provenance.inputs = report::hash_inputs(campaign, {}, more_inputs);
    return write_diagnosis(held, options, {campaign, found, reasons, provenance});
  }
  const report::EarlierFit earlier = report::read_fit(options.fit, campaign.rig.plant);
  std::vector<report::TableLimit> limits;
  if (!options.table.empty()) limits = take_table(options.table, earlier, campaign);
  diagnosis::DiagnosisOptions settings;
  settings.threads = options.common.threads;
  settings.truth = truth_beside(campaign);
  const LeakRecords records = load_leak_records(campaign, settings.threads);
  provenance.inputs = report::hash_inputs(campaign, records.averages(), more_inputs);
  {
    CountProgress progress(options.common.print.quiet, "records");
    settings.progress = std::ref(progress);
    found = diagnosis::diagnose(campaign, records.conditions,
                                {earlier.values, earlier.indices, earlier.covariance}, settings);
  }
  found.warnings.insert(found.warnings.end(), records.left_out.begin(), records.left_out.end());
  warn_of_validity(campaign, earlier.validity, found);
  warn_of_recordings(records.averages(), found);
  if (!limits.empty()) warn_of_absent(limits, campaign, found);
  warn_of_fit(earlier, found);
  return write_diagnosis(held, options, {campaign, found, reasons, provenance, limits});
}

}  // namespace

Run add_diagnose(CLI::App& verb) {
  const auto options = std::make_shared<DiagnoseRequest>();
  add_campaign_options(verb, options->common);
  verb.add_option("--fit", options->fit, "fit.json of a fit to healthy records of the rig")
      ->check(not_empty());
  verb.add_option("--table", options->table,
                  "leak_table.json of the same rig: its rows are the limits of the classes")
      ->check(not_empty());
  verb.add_option("--healthy", options->healthy,
                  "leak level that is healthy, besides those that the campaign knows; repeatable")
      ->allow_extra_args(false);
  return [options](const Invocation& invocation) { return run_diagnose(*options, invocation); };
}

}  // namespace rigcal::app
