#pragma once

#include <functional>
#include <memory>

#include "apps/rigcal/options.hpp"
#include "apps/rigcal/verb.hpp"
#include "common/error.hpp"
#include "report/job/job.hpp"

namespace rigcal::app {

void add_strict_option(CLI::App& verb, bool& strict);

/// Loads the campaign. The pointer is shared because a fit keeps its campaign alive.
std::shared_ptr<const datasets::Campaign> loaded(const CampaignOptions& options);

using Job = std::function<report::JobResult(const report::JobTerms&)>;

/// What a signal ends if it arrives during the main computation of a job: the whole process, or
/// only the computation. In the second case the result so far is written.
enum class OnSignal { end, keep_result };

/// Runs a job for the folder of --out, writes its files with the page, and prints its document.
///
/// @param verb  name of the verb for messages
/// @throws WriteError, UsageError, InputError  if the job, or writing its files or output, fails
ExitCode run_job(const char* verb, const CampaignOptions& options, const Invocation& invocation,
                 const Job& job, OnSignal on_signal = OnSignal::end);
ExitCode run_job(const char* verb, const JobOptions& options, const Invocation& invocation,
                 const Job& job, OnSignal on_signal = OnSignal::end);

}  // namespace rigcal::app
