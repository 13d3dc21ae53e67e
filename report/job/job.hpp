#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "calib/fit.hpp"
#include "common/error.hpp"
#include "common/task_farm.hpp"
#include "datasets/record.hpp"
#include "report/batch/batch_rigs.hpp"
#include "report/run/campaign_choice.hpp"
#include "report/run/fit_choices.hpp"
#include "report/run/write_result.hpp"
#include "report/store/folder.hpp"
#include "report/store/json.hpp"

// The jobs of verbs that command and Python module run alike: each takes a campaign and a few
// choices, and returns its result files. The caller draws the page, writes and prints.

namespace rigcal::report {

/// A fit or validation with all that its files are made from.
struct FitRun {
  ResultKind kind = ResultKind::fit;
  std::shared_ptr<const datasets::Campaign> campaign;
  std::vector<datasets::Record> records;
  Provenance provenance;
  calib::Fit fit;

  /// Borrows from this one.
  Result result() const { return {kind, *campaign, records, fit, provenance}; }
};

/// What a caller lends to a job.
struct JobTerms {
  std::string command;                                       ///< for the provenance
  std::vector<std::pair<std::string, std::string>> options;  ///< choices of the campaign, likewise
  int threads = 1;
  const std::atomic<bool>& cancel;  ///< ends the job
  std::filesystem::path out = {};   ///< folder that the files are for, if it is known
  /// Called once before the long work, with the files that the job may make. It may refuse by an
  /// exception.
  std::function<void(PlannedFiles)> hold = {};
  /// Done and all of the named pieces; may be called from any thread.
  std::function<void(const char* pieces, int done, int all)> progress = {};
  /// Called before a search, to attach the progress of one. `work` names it, with braces in place
  /// of the number of its start.
  std::function<void(calib::FitOptions&, const std::string& work)> watch = {};
  std::function<void(const std::string&)> note = {};  ///< takes a sentence for the user
  TaskFarm* processes = nullptr;  ///< that do the same job together; null: this one alone

  /// Among cooperating processes only the first one has a result.
  bool leads() const { return processes == nullptr || processes->rank() == 0; }
};

/// A finished job.
struct JobResult {
  /// Without the page; the JSON that marks it complete is last. Empty for a fit, whose files are
  /// made as they are written: all at once would be the most memory that it takes.
  std::vector<ResultFile> files;
  std::shared_ptr<FitRun> fit;     ///< null for other jobs
  std::vector<std::string> first;  ///< files to be opened first
  std::vector<InputFile> inputs;
  ExitCode code = ExitCode::done;
  bool unchanged = false;         ///< its result was in the folder already; the JSON is in `files`
  std::function<void()> written;  ///< called once its files are written
};

/// Draws the page of a job and writes its files.
///
/// @throws WriteError, UsageError  as write_results()
WrittenResult write_job(HeldFolder& held, int threads, JobResult job);

/// The fit that a job rests on: a fit.json, or one of this process.
struct FitSource {
  std::filesystem::path file;  ///< empty: none
  std::shared_ptr<const EarlierFit> made = {};

  bool given() const { return made || !file.empty(); }
  /// @throws InputError  as read_fit()
  EarlierFit read(model::PlantKind plant) const;
  /// For messages.
  std::string name() const;
  /// The file, for the hashes of the inputs; nothing for a fit of this process.
  std::vector<std::filesystem::path> inputs() const;
};

/// The record of every condition that has one and is not ignored, in the campaign's order, warned
/// about where it is short beside the others.
///
/// @throws InputError  a record is wrong, or there is none
std::vector<datasets::Record> averaged_records(const datasets::Campaign& campaign,
                                               const JobTerms& terms);
/// These records with their repeatability.
JobResult average_job(const datasets::Campaign& campaign,
                      const std::vector<datasets::Record>& records, const JobTerms& terms);

struct FitRequest {
  FitChoices choices;
  bool strict = false;      ///< WARN counts as FAIL
  bool resume = false;      ///< a fit of the same inputs and options that was stopped goes on
  bool if_changed = false;  ///< nothing is done where the whole result is there already
};
/// Estimates the free parameters and scores the conditions. Where a folder is known, the fit keeps
/// in it what it needs to go on after a kill.
///
/// @throws InputError, UsageError
JobResult fit_job(std::shared_ptr<const datasets::Campaign> campaign, const FitRequest& request,
                  const JobTerms& terms);

struct ValidationRequest {
  FitSource fit;  ///< none: the campaign's own values
  bool strict = false;
};
/// Scores the conditions with the values of an earlier fit.
///
/// @throws InputError, UsageError
JobResult validation_job(std::shared_ptr<const datasets::Campaign> campaign,
                         const ValidationRequest& request, const JobTerms& terms);

struct DiagnosisRequest {
  FitSource fit;
  std::filesystem::path table;       ///< leak_table.json whose rows limit the classes; may be empty
  std::vector<std::string> healthy;  ///< further leak levels that are healthy
};
/// Leaks of every record that can be diagnosed.
///
/// @throws InputError, UsageError
JobResult diagnosis_job(datasets::Campaign campaign, const DiagnosisRequest& request,
                        const JobTerms& terms);

struct ParityRequest {
  FitSource fit;
  double false_alarm_percent = 1.0;
  std::vector<std::string> healthy;
};
/// Parity residuals of every record against the healthy rig.
///
/// @throws InputError, UsageError
JobResult parity_job(datasets::Campaign campaign, const ParityRequest& request,
                     const JobTerms& terms);

struct LeakTableRequest {
  FitSource fit;                        ///< none: the campaign's values and assumptions
  std::vector<double> targets_percent;  ///< empty: the campaign's
  std::vector<std::string> signals;     ///< "sine@0.1Hz@20mm"; empty: the campaign's
};
/// Assumptions of a leak table from its published numbers, and the table with them.
///
/// @throws InputError, UsageError
JobResult fit_tables_job(const CampaignChoice& choice, const JobTerms& terms);

/// The leak table of a rig. It reads the campaign itself, since --set reaches its assumptions too.
///
/// @throws InputError, UsageError
JobResult leak_table_job(const CampaignChoice& choice, const LeakTableRequest& request,
                         const JobTerms& terms);

struct PlanRequest {
  FitSource fit;                    ///< values that are taken; none: the campaign's own
  std::vector<std::string> design;  ///< parameters that a test is designed for; may be empty
};
/// What the records of a campaign will determine, and a test within the limits of its [design].
///
/// @throws InputError, UsageError
JobResult plan_job(const datasets::Campaign& campaign, const PlanRequest& request,
                   const JobTerms& terms);

struct BatchRequest {
  std::filesystem::path folder;  ///< every campaign.toml beneath it is a rig
  std::filesystem::path root;    ///< no file outside this folder is read; empty: no restriction
  std::vector<std::filesystem::path> earlier;  ///< folders of earlier batches, for the trends
  FitChoices choices;
  bool strict = false;
  bool resume = false;  ///< whole results are kept, and stopped fits go on
  bool diagnose = false;
  bool force = false;
  int jobs = 1;  ///< rigs at a time
};
/// Every rig beneath a folder: its fit, and its trend over earlier batches. The results of each rig
/// are written into a folder of its own in that of the terms.
///
/// @param verbs  how a rig is fitted and diagnosed
/// @throws UsageError
JobResult batch_job(const BatchRequest& request, const RigVerbs& verbs, const JobTerms& terms);

/// Fits and diagnoses the rigs of a batch in this process.
///
/// @param terms  borrowed
RigVerbs verbs_in_process(const BatchRequest& request, const JobTerms& terms);

/// Results of two folders or more beside each other; the first is what the others are compared
/// with.
///
/// @throws InputError, UsageError
JobResult comparison_job(const std::vector<std::filesystem::path>& folders, const JobTerms& terms);

}  // namespace rigcal::report
