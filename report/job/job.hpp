#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calib/fit.hpp"
#include "calib/problem/simulation_task.hpp"
#include "common/error.hpp"
#include "common/task_farm.hpp"
#include "datasets/record.hpp"
#include "report/batch/batch_rigs.hpp"
#include "report/run/campaign_choice.hpp"
#include "report/run/fit_choices.hpp"
#include "report/run/write_result.hpp"
#include "report/store/folder.hpp"
#include "report/store/json.hpp"

// The jobs behind the verbs that the command line and the Python module have in common. Each takes
// a campaign and a few choices, and returns its result files. The caller draws the page, writes the
// files and prints.

namespace rigcal::report {

/// A fit or validation with everything needed to write its files.
struct FitRun {
  ResultKind kind = ResultKind::fit;
  std::shared_ptr<const datasets::Campaign> campaign;
  std::vector<datasets::Record> records;
  Provenance provenance;
  calib::Fit fit;

  /// Returns a view that borrows from this object.
  Result result() const { return {kind, *campaign, records, fit, provenance}; }
};

/// What the caller provides for a job.
struct JobTerms {
  std::string command;                                       ///< command line for the provenance
  std::vector<std::pair<std::string, std::string>> options;  ///< campaign choices, for provenance
  int threads = 1;
  const std::atomic<bool>& cancel;  ///< set to true to stop the job
  std::filesystem::path out = {};   ///< folder for the files, if it is known
  /// Called once before the long computation with the files that the job may write. Throws to
  /// refuse them.
  std::function<void(PlannedFiles)> hold = {};
  /// Reports progress: how many of the named pieces are done. May be called from any thread.
  std::function<void(const char* pieces, int done, int all)> progress = {};
  /// Called before a search to attach progress reporting. `work` names the search, with braces in
  /// place of the start number.
  std::function<void(calib::FitOptions&, const std::string& work)> watch = {};
  std::function<void(const std::string&)> note = {};  ///< passes a sentence to the user
  TaskFarm* processes = nullptr;  ///< processes running the same job; null: only this process

  /// Returns true if this process produces the result. Among cooperating processes only the first
  /// one does.
  bool leads() const { return processes == nullptr || processes->rank() == 0; }
};

/// Simulated conditions.
struct SimulationRun {
  std::vector<calib::SimulationTask> tasks;
  std::vector<model::Simulation> simulations;  ///< one per task
};

/// What the command prints for a job that has no page.
struct Printed {
  std::string text;
  Json json;
  std::string problems;  ///< why parts of the result are missing; empty if none are
};

/// A finished job.
struct JobResult {
  /// All files except the page. The last one is the JSON file that marks the result as complete.
  /// Empty for a fit, whose files are created while they are written, because all of them together
  /// would be its peak memory use.
  std::vector<ResultFile> files;
  std::shared_ptr<FitRun> fit;                 ///< null for other jobs
  std::shared_ptr<SimulationRun> simulations;  ///< null for other jobs
  std::optional<Printed> printed;              ///< absent for a job with a page
  std::vector<std::string> first;              ///< files to open first
  std::vector<InputFile> inputs;
  ExitCode code = ExitCode::done;
  bool unchanged = false;         ///< the result already existed; `files` contains its JSON file
  std::function<void()> written;  ///< called after the files have been written
};

/// Draws the page of a job, if it has one, and writes its files.
///
/// @throws WriteError, UsageError  as for write_results()
WrittenResult write_job(HeldFolder& held, int threads, JobResult job);

struct SimulationRequest {
  std::vector<std::string> conditions;   ///< ids; empty: all that are not ignored
  const char* argument = "--condition";  ///< name of these ids in messages
  /// Makes the task of a condition; empty: with the values of the campaign.
  std::function<calib::SimulationTask(const datasets::Condition&)> task = {};
};
/// Simulates conditions. There is a file for each if the result folder is known.
///
/// @param campaign  borrowed by the tasks of the result
/// @throws InputError  if a record that drives the model is invalid
/// @throws UsageError  if no condition has one of the ids
JobResult simulation_job(const datasets::Campaign& campaign, const SimulationRequest& request,
                         const JobTerms& terms);

/// The fit that a job is based on: a fit.json, or a fit made in this process.
struct FitSource {
  std::filesystem::path file;  ///< empty if there is no file
  std::shared_ptr<const EarlierFit> made = {};

  bool given() const { return made || !file.empty(); }
  /// @throws InputError  as for read_fit()
  EarlierFit read(model::PlantKind plant) const;
  /// Returns the name of the fit for messages.
  std::string name() const;
  /// Returns the file, so that it can be hashed as an input; empty for a fit made in this process.
  std::vector<std::filesystem::path> inputs() const;
};

/// Returns the averaged record for every condition that has one and is not ignored, in campaign
/// order. Adds warnings for records that are short compared with the others.
///
/// @throws InputError  if a record is invalid, or there are no records
std::vector<datasets::Record> averaged_records(const datasets::Campaign& campaign,
                                               const JobTerms& terms);
/// Reports the averaged records with their repeatability.
JobResult average_job(const datasets::Campaign& campaign,
                      const std::vector<datasets::Record>& records, const JobTerms& terms);

struct FitRequest {
  FitChoices choices;
  bool strict = false;      ///< treat WARN as FAIL
  bool resume = false;      ///< resume a stopped fit with the same inputs and options
  bool if_changed = false;  ///< do nothing if the complete result already exists
};
/// Estimates the free parameters and scores the conditions. If the result folder is known, the fit
/// stores there what it needs to resume after it was killed.
///
/// @throws InputError, UsageError  if a record, the campaign or the request is invalid
JobResult fit_job(std::shared_ptr<const datasets::Campaign> campaign, const FitRequest& request,
                  const JobTerms& terms);

struct ValidationRequest {
  FitSource fit;  ///< if absent, the values of the campaign are used
  bool strict = false;
};
/// Scores the conditions with the values from an earlier fit.
///
/// @throws InputError, UsageError  if a record, the earlier fit or the request is invalid
JobResult validation_job(std::shared_ptr<const datasets::Campaign> campaign,
                         const ValidationRequest& request, const JobTerms& terms);

struct DiagnosisRequest {
  FitSource fit;
  std::filesystem::path table;       ///< leak_table.json that defines the class limits; may be
                                     ///< empty
  std::vector<std::string> healthy;  ///< additional leak levels that count as healthy
};
/// Estimates the leak in every record that can be diagnosed.
///
/// @throws InputError, UsageError  if a file or the request is invalid
JobResult diagnosis_job(datasets::Campaign campaign, const DiagnosisRequest& request,
                        const JobTerms& terms);

struct ParityRequest {
  FitSource fit;
  double false_alarm_percent = 1.0;
  std::vector<std::string> healthy;
};
/// Computes the parity residuals of every record relative to the healthy rig.
///
/// @throws InputError, UsageError  if a file or the request is invalid
JobResult parity_job(datasets::Campaign campaign, const ParityRequest& request,
                     const JobTerms& terms);

struct LeakTableRequest {
  FitSource fit;                        ///< if absent, campaign values and assumptions are used
  std::vector<double> targets_percent;  ///< empty: the targets in the campaign
  std::vector<std::string> signals;     ///< such as "sine@0.1Hz@20mm"; empty: the campaign's
};
/// Estimates the assumptions of a leak table from its published numbers, and computes the table
/// with them.
///
/// @throws InputError, UsageError  if the campaign or its [leak_table] is invalid
JobResult fit_tables_job(const CampaignChoice& choice, const JobTerms& terms);

/// Computes the leak table of a rig. Takes the choice instead of a loaded campaign, because --set
/// also applies to the assumptions.
///
/// @throws InputError, UsageError  if a file or the request is invalid
JobResult leak_table_job(const CampaignChoice& choice, const LeakTableRequest& request,
                         const JobTerms& terms);

struct PlanRequest {
  FitSource fit;                    ///< values for the plan; if absent, those of the campaign
  std::vector<std::string> design;  ///< parameters to design a test for; may be empty
};
/// Predicts how well the records of a campaign will determine the parameters, and designs a test
/// within the limits in [design].
///
/// @throws InputError, UsageError  if a file or the request is invalid
JobResult plan_job(const datasets::Campaign& campaign, const PlanRequest& request,
                   const JobTerms& terms);

struct BatchRequest {
  std::filesystem::path folder;  ///< every campaign.toml below this folder is a rig
  std::filesystem::path root;    ///< no file outside this folder is read; empty: no restriction
  std::vector<std::filesystem::path> earlier;  ///< folders of earlier batches, for the trends
  FitChoices choices;
  bool strict = false;
  bool resume = false;  ///< keep complete results and resume stopped fits
  bool diagnose = false;
  bool force = false;
  int jobs = 1;  ///< number of rigs processed at the same time
};
/// Fits every rig below a folder and follows its estimates over earlier batches. The results of
/// each rig are written into a subfolder of `terms.out`.
///
/// @param verbs  how a rig is fitted and diagnosed
/// @throws UsageError  under the conditions of find_rigs(), or if the request is invalid
JobResult batch_job(const BatchRequest& request, const RigVerbs& verbs, const JobTerms& terms);

/// Returns functions that fit and diagnose the rigs of a batch in this process.
///
/// @param terms  borrowed
RigVerbs verbs_in_process(const BatchRequest& request, const JobTerms& terms);

/// Compares the results in two or more folders. The first result is the reference for the others.
///
/// @throws InputError, UsageError  if a result cannot be read, or if the folders are fewer than two
///                         or not distinct
JobResult comparison_job(const std::vector<std::filesystem::path>& folders, const JobTerms& terms);

}  // namespace rigcal::report
