#pragma once

#include <functional>
#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/verb.hpp"
#include "common/error.hpp"
#include "report/job/job.hpp"

namespace rigcal::app {

/// --strict
void add_strict_option(CLI::App& verb, bool& strict);

/// The campaign of the options, as a fit keeps it.
std::shared_ptr<const datasets::Campaign> loaded(const CampaignOptions& options);

using Job = std::function<report::JobResult(const report::JobTerms&)>;

/// Whether a signal during the long work of a job ends the process, or the work, whose result so
/// far is then written.
enum class OnSignal { end, keep_result };

/// Runs a job in the folder of --out, writes its files with the page, and prints its document.
///
/// @param verb  for messages
/// @throws WriteError, UsageError, InputError
ExitCode run_job(const char* verb, const CampaignOptions& options, const Invocation& invocation,
                 const Job& job, OnSignal on_signal = OnSignal::end);
ExitCode run_job(const char* verb, const JobOptions& options, const Invocation& invocation,
                 const Job& job, OnSignal on_signal = OnSignal::end);

}  // namespace rigcal::app
