#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/verb.hpp"
#include "common/error.hpp"
#include "report/document/document.hpp"
#include "report/job/job.hpp"
#include "report/store/result.hpp"

namespace rigcal::app {

/// Exit code of a fit or validation: failed, stopped, or by its verdict.
///
/// @param strict  WARN counts as FAIL
ExitCode exit_code_of(calib::FitStatus status, std::optional<calib::Verdict> verdict, bool strict);

/// Writes the files of a fit or validation into the held folder of --out, and prints scorecard,
/// parameters and verdict.
///
/// @throws WriteError
ExitCode write_and_print(report::HeldFolder& held, const CampaignOptions& options,
                         const report::Result& result, bool strict);

/// --strict
void add_strict_option(CLI::App& verb, bool& strict);

/// Runs a job in the folder of --out, writes its files with the page, and prints its document.
///
/// @param verb  for messages
/// @throws WriteError, UsageError, InputError
ExitCode run_job(const char* verb, const CampaignOptions& options, const Invocation& invocation,
                 const std::function<report::JobResult(const report::JobTerms&)>& job);
ExitCode run_job(const char* verb, const JobOptions& options, const Invocation& invocation,
                 const std::function<report::JobResult(const report::JobTerms&)>& job);

/// A result as its document shows it, on page and terminal alike.
struct PrintedDocument {
  report::doc::Verdict verdict;
  std::vector<report::doc::Section> sections;
  bool synthetic = false;  ///< its records are
};

/// The text of a document, in as many lines as a terminal should have of it.
std::string text_of(const PrintedDocument& document, const PrintOptions& options);

/// Prints a result on stdout, as text or as JSON, and where its files are.
///
/// @param files  of the folder, those to be opened first
/// @throws WriteError  stdout does not take it
void print(const PrintOptions& options, const PrintedDocument& document,
           const std::filesystem::path& folder, const std::vector<std::string>& files,
           const report::Json& json);

}  // namespace rigcal::app
