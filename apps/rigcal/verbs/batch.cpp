#include "report/batch/batch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <system_error>

#include "apps/rigcal/batch_rigs.hpp"
#include "apps/rigcal/fit_choices.hpp"
#include "apps/rigcal/interrupt.hpp"
#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/verb.hpp"
#include "common/error.hpp"
#include "common/file.hpp"
#include "common/printable.hpp"
#include "report/page/page_batch.hpp"
#include "report/run/result_page.hpp"
#include "report/store/folder.hpp"
#include "report/store/stored.hpp"

namespace rigcal::app {
namespace {

namespace fs = std::filesystem;

constexpr int kMostJobs = 1024;

struct BatchRequest {
  fs::path folder;
  fs::path out = "rigcal-out";
  fs::path root;
  std::vector<fs::path> earlier;
  FitChoices choices;
  int jobs = 1;
  int threads = 1;
  bool resume = false;
  bool diagnose = false;
  bool force = false;
  PrintOptions print;
};

void require_other_folders(const BatchRequest& options) {
  for (const fs::path& earlier : options.earlier) {
    std::error_code unknown;  // --out need not be there yet
    if (fs::equivalent(earlier, options.out, unknown))
      throw UsageError(fmt::format(
          "batch: --earlier {} is where the results go; expected the --out of another batch",
          earlier.string()));
  }
}

report::Compared read_fit_of(const fs::path& folder) {
  return report::load_compared_file(folder / "fit.json", folder.string());
}

/// Adds the results of earlier batches for a rig; `unread` lists those that could not be read.
void add_earlier(const BatchRequest& options, report::RigRun& run) {
  for (const fs::path& batch : options.earlier) {
    const fs::path folder = batch / run.folder;
    if (!fs::exists(folder / "fit.json")) continue;
    try {
      run.earlier.push_back(read_fit_of(folder));
    } catch (const InputError& error) {
      run.unread.push_back(fmt::format("an earlier result is left out: {}", error.what()));
    }
  }
}

report::RigRun finished(const BatchRequest& options, const BatchRig& rig, const RigEnd& end) {
  report::RigRun run;
  run.rig = rig.rig;
  run.campaign = rig.campaign;
  run.folder = rig.folder;
  run.code = end.code;
  run.unchanged = end.unchanged;
  run.seconds = end.seconds;
  run.error = end.error;
  if (!end.left_result) return run;
  const fs::path folder = options.out / rig.folder;
  try {
    run.result = read_fit_of(folder);
  } catch (const InputError& error) {
    run.code = ExitCode::internal;
    run.error = error.what();
    return run;
  }
  add_earlier(options, run);
  return run;
}

std::vector<std::pair<std::string, std::string>> recorded(const BatchRequest& options) {
  std::vector<std::string> earlier;
  for (const fs::path& each : options.earlier) earlier.push_back(each.string());
  return {{"fit", fmt::format("{}", fmt::join(arguments_of(options.choices), " "))},
          {"diagnose", options.diagnose ? "true" : "false"},
          {"earlier", fmt::format("{}", fmt::join(earlier, ", "))}};
}

/// The campaign files that can be read, and the earlier results.
std::vector<report::InputFile> inputs_of(const std::vector<report::RigRun>& runs) {
  std::vector<report::InputFile> inputs;
  const auto add = [&](const fs::path& file) {
    try {
      inputs.push_back({file.string(), sha256_of_file(file)});
    } catch (const InputError&) {
      // The rig's own row says so.
    }
  };
  for (const report::RigRun& run : runs) {
    add(run.campaign);
    for (const report::Compared& earlier : run.earlier) add(earlier.file);
  }
  return inputs;
}

/// A line for each rig that has ended, in the order of their ends.
class EndedRigs {
 public:
  EndedRigs(bool quiet, std::size_t all) : quiet_(quiet), all_(all) {}

  void operator()(const BatchRig& rig, const RigEnd& end) {
    const std::lock_guard lock(mutex_);
    ++ended_;
    if (quiet_) return;
    say(fmt::format("{} of {} rigs: {}: {}, exit {}, {:.1f} s{}\n", ended_, all_, rig.rig,
                    end.unchanged ? "unchanged" : "done", static_cast<int>(end.code), end.seconds,
                    end.error.empty() ? "" : ": " + end.error));
  }

 private:
  std::mutex mutex_;
  bool quiet_;
  std::size_t all_;
  std::size_t ended_ = 0;
};

RigTask task_of(const BatchRequest& options) {
  RigTask task;
  task.out = options.out;
  task.root = options.root;
  task.fit_arguments = arguments_of(options.choices);
  task.threads = std::max(1, options.threads / options.jobs);
  task.resume = options.resume;
  task.diagnose = options.diagnose;
  task.force = options.force;
  return task;
}

ExitCode run_batch(const BatchRequest& options, const Invocation& invocation) {
  require_other_folders(options);
  const std::vector<BatchRig> rigs = find_rigs(options.folder, options.out);
  const Kept kept;
  ThreadFarm threads;
  TaskFarm& farm = invocation.processes != nullptr ? *invocation.processes : threads;
  const RigTask task = task_of(options);
  const auto make = [&](std::size_t i) -> TaskResult {
    return {bytes_of(run_rig(rigs[i], task, invocation.cancel))};
  };
  const FarmJob job{"rigs", {}, rigs.size(), options.jobs, {}};
  if (!invocation.leads()) {
    farm.run(job, make, {});
    return ExitCode::done;
  }
  report::HeldFolder held(options.out, holding("batch", options.force, options.print));
  held.plan({{"batch.json", "batch.csv", "report.html"}, {}});
  EndedRigs ended(options.print.quiet, rigs.size());
  const auto ends = farm.run(job, make, [&](std::size_t i, const TaskResult& result) {
    ended(rigs[i], rig_end_of(result.bytes));
  });

  std::vector<report::RigRun> runs;
  report::StoredBatch batch;
  batch.folder = options.folder.string();
  if (invocation.cancel) batch.status = "stopped";
  for (std::size_t i = 0; i < rigs.size(); ++i) {
    runs.push_back(finished(options, rigs[i], rig_end_of(ends[i].bytes)));
    batch.rigs.push_back(report::rig_row(runs.back()));
    batch.exit_code = std::max(batch.exit_code, batch.rigs.back().exit_code);
  }
  const report::Provenance provenance{invocation.command, options.choices.seed, recorded(options),
                                      inputs_of(runs)};
  batch.provenance = report::stored(provenance);
  const report::Json json = report::json_of(batch);
  std::vector<report::ResultFile> files{{"batch.csv", report::batch_csv(batch)},
                                        {"batch.json", report::json_text(json)}};
  add_page(options.out, options.threads, files);
  report::write_results(held, files, provenance.inputs);
  print(options.print, {report::batch_headline(batch), report::batch_sections(batch)}, options.out,
        {"report.html", "batch.json", "batch.csv"}, json);
  return static_cast<ExitCode>(batch.exit_code);
}

}  // namespace

Run add_batch(CLI::App& verb) {
  const auto options = std::make_shared<BatchRequest>();
  options->threads = hardware_threads();
  verb.add_option("FOLDER", options->folder, "Every campaign.toml beneath it is a rig")
      ->required()
      ->check(CLI::ExistingDirectory);
  verb.add_option("--out", options->out, "Folder of the results: one folder for each rig")
      ->check(not_empty())
      ->capture_default_str();
  verb.add_option("--root", options->root,
                  "Read no campaign and no recording outside this folder, wherever links lead")
      ->check(not_empty());
  add_force_option(verb, options->force);
  verb.add_option("--earlier", options->earlier,
                  "--out of an earlier batch, for the trends; repeatable")
      ->allow_extra_args(false)
      ->check(CLI::ExistingDirectory);
  verb.add_option("--jobs", options->jobs, "Rigs at a time")
      ->check(CLI::Range(1, kMostJobs))
      ->capture_default_str();
  verb.add_option("--threads", options->threads,
                  "Threads of all rigs together; results do not depend on it")
      ->check(CLI::Range(1, kMostJobs))
      ->default_str("all");
  verb.add_flag("--resume", options->resume,
                "Keep whole results of the same inputs and options; go on where a fit was stopped");
  verb.add_flag("--diagnose", options->diagnose, "Diagnose the records of each rig by its fit");
  add_fit_choices(verb, options->choices);
  add_print_options(verb, options->print);
  return [options](const Invocation& invocation) { return run_batch(*options, invocation); };
}

}  // namespace rigcal::app
