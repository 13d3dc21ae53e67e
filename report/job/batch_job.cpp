#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <system_error>

#include "common/file.hpp"
#include "report/batch/batch.hpp"
#include "report/job/job.hpp"

namespace rigcal::report {
namespace {

namespace fs = std::filesystem;

void require_other_folders(const BatchRequest& request, const fs::path& out) {
  for (const fs::path& earlier : request.earlier) {
    std::error_code unknown;  // the error is ignored: --out may not exist yet
    if (fs::equivalent(earlier, out, unknown))
      throw UsageError(
          fmt::format("batch: --earlier {} is the folder of the new results; expected the --out of "
                      "another batch",
                      earlier.string()));
  }
}

Compared read_fit_of(const fs::path& folder) {
  return load_compared_file(folder / "fit.json", folder.string());
}

/// Adds the results for a rig from earlier batches; `unread` lists those that could not be read.
void add_earlier(const BatchRequest& request, RigRun& run) {
  for (const fs::path& batch : request.earlier) {
    const fs::path folder = batch / run.folder;
    if (!fs::exists(folder / "fit.json")) continue;
    try {
      run.earlier.push_back(read_fit_of(folder));
    } catch (const InputError& error) {
      run.unread.push_back(fmt::format("an earlier result is left out: {}", error.what()));
    }
  }
}

RigRun finished(const BatchRequest& request, const fs::path& out, const BatchRig& rig,
                const RigEnd& end) {
  RigRun run{rig, end};
  if (!end.left_result) return run;
  try {
    run.result = read_fit_of(out / rig.folder);
  } catch (const InputError& error) {
    // A verb may have refused the result already, such as one with a number that is too large.
    if (end.code != ExitCode::bad_input) run.code = ExitCode::internal;
    run.error = error.what();
    return run;
  }
  add_earlier(request, run);
  return run;
}

std::vector<std::pair<std::string, std::string>> options_of(const BatchRequest& request) {
  std::vector<std::string> choices = arguments_of(request.choices);
  if (request.strict) choices.emplace_back("--strict");
  std::vector<std::string> earlier;
  for (const fs::path& each : request.earlier) earlier.push_back(each.string());
  return {{"fit", fmt::format("{}", fmt::join(choices, " "))},
          {"diagnose", request.diagnose ? "true" : "false"},
          {"earlier", fmt::format("{}", fmt::join(earlier, ", "))}};
}

/// Lists the readable campaign files and the earlier results.
std::vector<InputFile> inputs_of(const std::vector<RigRun>& runs) {
  std::vector<InputFile> inputs;
  const auto add = [&](const fs::path& file) {
    try {
      inputs.push_back({file.string(), sha256_of_file(file)});
    } catch (const InputError&) {
      // The row of the rig reports this error.
    }
  };
  for (const RigRun& run : runs) {
    add(run.campaign);
    for (const Compared& earlier : run.earlier) add(earlier.file);
  }
  return inputs;
}

/// Prints a note for each rig as its run ends.
class EndedRigs {
 public:
  EndedRigs(const JobTerms& terms, std::size_t all) : terms_(terms), all_(all) {}

  void operator()(const BatchRig& rig, const RigEnd& end) {
    const std::lock_guard lock(mutex_);
    ++ended_;
    if (!terms_.note)
      return terms_.progress("rigs", static_cast<int>(ended_), static_cast<int>(all_));
    terms_.note(fmt::format("{} of {} rigs: {}: {}, exit {}, {:.1f} s{}", ended_, all_, rig.rig,
                            end.unchanged ? "unchanged" : "done", static_cast<int>(end.code),
                            end.seconds, end.error.empty() ? "" : ": " + end.error));
  }

 private:
  std::mutex mutex_;
  const JobTerms& terms_;
  std::size_t all_;
  std::size_t ended_ = 0;
};

/// Runs a job for a rig and writes its files.
VerbEnd run_here(const char* verb, const BatchRequest& request, const BatchRig& rig,
                 const JobTerms& terms,
                 const std::function<JobResult(const CampaignChoice&, const JobTerms&)>& job) {
  const auto began = std::chrono::steady_clock::now();
  CampaignChoice choice;
  choice.campaign = rig.campaign;
  choice.root = request.root;
  JobTerms of_rig{terms.command, recorded(choice), terms.threads, terms.cancel,
                  terms.out / rig.folder};
  std::optional<HeldFolder> held;
  of_rig.hold = [&](PlannedFiles planned) {
    held.emplace(of_rig.out, Holding{verb, request.force});
    held->plan(std::move(planned));
  };
  of_rig.progress = [](const char*, int, int) {};
  VerbEnd end;
  try {
    JobResult result = job(choice, of_rig);
    end.code = result.code;
    if (!result.unchanged) write_job(held.value(), terms.threads, std::move(result));
  } catch (const Error& error) {
    end.code = error.code();
    end.error = error.what();
  } catch (const std::exception& error) {
    end.error = error.what();
  }
  std::replace(end.error.begin(), end.error.end(), '\n', ' ');
  end.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return end;
}

}  // namespace

RigVerbs verbs_in_process(const BatchRequest& request, const JobTerms& terms) {
  RigVerbs verbs;
  verbs.fit = [&](const BatchRig& rig) {
    return run_here(
        "fit", request, rig, terms, [&](const CampaignChoice& choice, const JobTerms& of_rig) {
          const FitRequest fit{request.choices, request.strict, request.resume, request.resume};
          return fit_job(std::make_shared<const datasets::Campaign>(load(choice)), fit, of_rig);
        });
  };
  if (!request.diagnose) return verbs;
  verbs.diagnose = [&](const BatchRig& rig) {
    return run_here(
        "diagnose", request, rig, terms, [](const CampaignChoice& choice, const JobTerms& of_rig) {
          return diagnosis_job(load(choice), {{of_rig.out / "fit.json"}, {}, {}}, of_rig);
        });
  };
  return verbs;
}

JobResult batch_job(const BatchRequest& request, const RigVerbs& verbs, const JobTerms& terms) {
  require_other_folders(request, terms.out);
  const std::vector<BatchRig> rigs = find_rigs(request.folder, terms.out);
  ThreadFarm threads;
  TaskFarm& farm = terms.processes != nullptr ? *terms.processes : threads;
  const auto make = [&](std::size_t i) -> TaskResult {
    return {bytes_of(run_rig(rigs[i], terms.out, verbs, terms.cancel))};
  };
  const FarmJob work{"rigs", {}, rigs.size(), request.jobs, {}};
  if (!terms.leads()) {
    farm.run(work, make, {});
    return {};
  }
  PlannedFiles planned{{"batch.json", "batch.csv", "report.html"}, {}};
  for (const BatchRig& rig : rigs) planned.result_folders.emplace_back(rig.folder);
  terms.hold(std::move(planned));
  EndedRigs ended(terms, rigs.size());
  const auto ends = farm.run(work, make, [&](std::size_t i, const TaskResult& result) {
    ended(rigs[i], rig_end_of(result.bytes));
  });
  std::vector<RigRun> runs;
  StoredBatch batch;
  batch.folder = request.folder.string();
  if (terms.cancel) batch.status = "stopped";
  for (std::size_t i = 0; i < rigs.size(); ++i) {
    runs.push_back(finished(request, terms.out, rigs[i], rig_end_of(ends[i].bytes)));
    batch.rigs.push_back(rig_row(runs.back()));
    batch.exit_code = std::max(batch.exit_code, batch.rigs.back().exit_code);
  }
  const Provenance provenance{terms.command, request.choices.seed, options_of(request),
                              inputs_of(runs)};
  batch.provenance = stored(provenance);
  JobResult job;
  job.files = {{"batch.csv", batch_csv(batch)}, json_file("batch.json", batch)};
  job.first = {"batch.json", "batch.csv"};
  job.inputs = provenance.inputs;
  job.code = static_cast<ExitCode>(batch.exit_code);
  return job;
}

}  // namespace rigcal::report
