#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "report/document/document.hpp"
#include "report/run/campaign_choice.hpp"
#include "report/store/folder.hpp"
#include "report/store/json.hpp"

// The jobs of verbs that command and Python module run alike: each takes a campaign and a few
// choices, and returns its result files with the document that shows them. The caller writes and
// prints.

namespace rigcal::report {

/// What a caller lends to a job.
struct JobTerms {
  std::string command;                                       ///< for the provenance
  std::vector<std::pair<std::string, std::string>> options;  ///< choices of the campaign, likewise
  int threads = 1;
  const std::atomic<bool>& cancel;  ///< ends the job
  /// Called once before the long work, with the files that the job may make. It may refuse by an
  /// exception.
  std::function<void(PlannedFiles)> hold = {};
  /// Done and all of the named pieces; may be called from any thread.
  std::function<void(const char* pieces, int done, int all)> progress = {};
};

/// A finished job.
struct JobResult {
  std::vector<ResultFile> files;   ///< without the page; the JSON that marks it complete is last
  std::vector<std::string> first;  ///< files to be opened first
  Json json;
  doc::Verdict verdict;
  std::vector<doc::Section> sections;
  bool synthetic = false;  ///< its records are
  std::vector<InputFile> inputs;
  ExitCode code = ExitCode::done;
};

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
/// The leak table of a rig. It reads the campaign itself, since --set reaches its assumptions too.
///
/// @throws InputError, UsageError
JobResult leak_table_job(const CampaignChoice& choice, const LeakTableRequest& request,
                         const JobTerms& terms);

/// What the records of a campaign will determine.
///
/// @throws InputError, UsageError
JobResult plan_job(const datasets::Campaign& campaign, const FitSource& fit, const JobTerms& terms);

/// Results of two folders or more beside each other; the first is what the others are compared
/// with.
///
/// @throws InputError, UsageError
JobResult comparison_job(const std::vector<std::filesystem::path>& folders, const JobTerms& terms);

}  // namespace rigcal::report
