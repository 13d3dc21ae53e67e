#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "apps/rigcal/child.hpp"
#include "apps/rigcal/fit_choices.hpp"
#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/verb.hpp"

namespace rigcal::app {
namespace {

namespace fs = std::filesystem;

constexpr int kMostJobs = 1024;

struct BatchOptions {
  fs::path folder;
  fs::path root;
  std::vector<fs::path> earlier;
  FitChoices choices;
  bool resume = false;
  bool diagnose = false;
  int jobs = 1;
  JobOptions common;
};

/// Returns the command line for one rig. It passes no data folder, so relative record paths start
/// at the folder of the campaign file, whatever the working folder is.
std::vector<std::string> arguments_for(const char* verb, const report::BatchRig& rig,
                                       const BatchOptions& options) {
  const int threads = std::max(1, options.common.threads / options.jobs);
  std::vector<std::string> arguments{
      verb,        rig.campaign.string(),      "--out",  (options.common.out / rig.folder).string(),
      "--threads", fmt::format("{}", threads), "--quiet"};
  if (!options.root.empty()) arguments.insert(arguments.end(), {"--root", options.root.string()});
  if (options.common.force) arguments.emplace_back("--force");
  return arguments;
}

report::VerbEnd fit_rig(const report::BatchRig& rig, const BatchOptions& options,
                        const std::atomic<bool>& cancel) {
  std::vector<std::string> arguments = arguments_for("fit", rig, options);
  const std::vector<std::string> choices = report::arguments_of(options.choices);
  arguments.insert(arguments.end(), choices.begin(), choices.end());
  if (options.choices.strict) arguments.emplace_back("--strict");
  if (options.resume) arguments.insert(arguments.end(), {"--resume", "--if-changed"});
  return run_child(arguments, cancel);
}

report::VerbEnd diagnose_rig(const report::BatchRig& rig, const BatchOptions& options,
                             const std::atomic<bool>& cancel) {
  std::vector<std::string> arguments = arguments_for("diagnose", rig, options);
  arguments.insert(arguments.end(),
                   {"--fit", (options.common.out / rig.folder / "fit.json").string()});
  return run_child(arguments, cancel);
}

/// Runs the batch. Each rig is fitted and diagnosed in separate processes.
ExitCode run_batch(const BatchOptions& options, const Invocation& invocation) {
  const report::BatchRequest request{options.folder,   options.root,           options.earlier,
                                     options.choices,  options.choices.strict, options.resume,
                                     options.diagnose, options.common.force,   options.jobs};
  report::RigVerbs verbs;
  verbs.fit = [&](const auto& rig) { return fit_rig(rig, options, invocation.cancel); };
  if (options.diagnose)
    verbs.diagnose = [&](const auto& rig) { return diagnose_rig(rig, options, invocation.cancel); };
  return run_job(
      "batch", options.common, invocation,
      [&](const report::JobTerms& terms) { return report::batch_job(request, verbs, terms); },
      OnSignal::keep_result);
}

}  // namespace

Run add_batch(CLI::App& verb) {
  const auto options = std::make_shared<BatchOptions>();
  JobOptions& common = options->common;
  common.threads = hardware_threads();
  verb.add_option("FOLDER", options->folder, "Every campaign.toml in this folder tree is a rig")
      ->required()
      ->check(CLI::ExistingDirectory);
  verb.add_option("--out", common.out, "Folder of the results: one folder for each rig")
      ->check(not_empty())
      ->capture_default_str();
  verb.add_option("--root", options->root,
                  "Read no campaign and no recording outside this folder, wherever links lead")
      ->check(not_empty());
  add_force_option(verb, common.force);
  verb.add_option("--earlier", options->earlier,
                  "results folder (--out) of an earlier batch, for trends; repeatable")
      ->allow_extra_args(false)
      ->check(CLI::ExistingDirectory);
  verb.add_option("--jobs", options->jobs, "Number of rigs at a time")
      ->check(CLI::Range(1, kMostJobs))
      ->capture_default_str();
  verb.add_option("--threads", common.threads,
                  "Total number of threads of all rigs; does not affect the results")
      ->check(CLI::Range(1, kMostJobs))
      ->default_str("all");
  verb.add_flag(
      "--resume", options->resume,
      "Keep complete results of the same inputs and options; continue fits that were stopped");
  verb.add_flag("--diagnose", options->diagnose, "Diagnose the records of each rig with its fit");
  add_fit_choices(verb, options->choices);
  add_print_options(verb, common.print);
  return [options](const Invocation& invocation) { return run_batch(*options, invocation); };
}

}  // namespace rigcal::app
