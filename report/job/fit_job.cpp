#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "calib/search/checkpoint.hpp"
#include "common/error.hpp"
#include "common/file.hpp"
#include "common/memory.hpp"
#include "datasets/prepare/load_record.hpp"
#include "diagnosis/drawn_shares.hpp"
#include "report/job/job.hpp"
#include "report/run/validation.hpp"
#include "report/store/checkpoint.hpp"
#include "report/store/folder.hpp"
#include "report/store/kept_tasks.hpp"
#include "report/store/stored.hpp"

namespace rigcal::report {
namespace {

/// File in the result folder from which a fit can resume after its process was killed.
class CheckpointFile {
 public:
  /// @param provenance  provenance of the fit; borrowed
  CheckpointFile(const std::filesystem::path& out, const Provenance& provenance)
      : file_(out / kCheckpointFile), provenance_(provenance) {}

  /// Reads the checkpoint of an earlier run of the same fit; std::nullopt if there is none.
  ///
  /// @throws InputError  if the file belongs to another fit, or is not a checkpoint
  std::optional<calib::Checkpoint> read() const {
    if (!std::filesystem::exists(file_)) return std::nullopt;
    return read_checkpoint(file_, provenance_);
  }

  /// Writes a checkpoint unless writing would take more than a twentieth of the time. A checkpoint
  /// that is not written is kept in memory.
  void keep(const calib::Checkpoint& checkpoint) {
    unwritten_ = checkpoint;
    if (Clock::now() >= not_before_) write();
  }

  /// If the fit was stopped, writes the checkpoint that is still in memory. Otherwise removes the
  /// file.
  void finish(calib::FitStatus status) {
    if (status != calib::FitStatus::stopped) {
      remove_stale(file_);
    } else if (unwritten_) {
      write();
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  void write() {
    constexpr int kShare = 20;  // pause after a write, as a multiple of the time that it took
    const auto began = Clock::now();
    write_file_atomically(file_, checkpoint_text(*unwritten_, provenance_));
    const auto ended = Clock::now();
    not_before_ = ended + kShare * (ended - began);
    unwritten_.reset();
  }

  std::filesystem::path file_;
  const Provenance& provenance_;
  std::optional<calib::Checkpoint> unwritten_;
  Clock::time_point not_before_{};
};

using calib::FitStatus;
using datasets::Use;

/// @param strict  true to treat WARN as FAIL
ExitCode code_of(FitStatus status, std::optional<calib::Verdict> verdict, bool strict) {
  switch (status) {
    case FitStatus::failed:
      return ExitCode::no_result;
    case FitStatus::stopped:
      return ExitCode::stopped;
    case FitStatus::converged:
      break;
  }
  const bool failed =
      verdict == calib::Verdict::fail || (strict && verdict == calib::Verdict::warn);
  return failed ? ExitCode::verdict_fail : ExitCode::done;
}

/// The state of an unfinished fit, stored in its folder so that the fit can resume after it was
/// killed. It is identified by the provenance of the starts, because bootstrap, profiles and
/// cross-validation do not change them.
struct Unfinished {
  Unfinished(const std::filesystem::path& out, Provenance searched, TaskFarm* processes,
             bool resume)
      : of_starts(std::move(searched)),
        checkpoint(out, of_starts),
        tasks(processes != nullptr ? *processes : threads, out / kKeptTasksFile, of_starts,
              resume) {}

  Provenance of_starts;
  ThreadFarm threads;
  CheckpointFile checkpoint;
  KeptTasks tasks;
};

std::shared_ptr<FitRun> begun(std::shared_ptr<const datasets::Campaign> campaign, ResultKind kind,
                              int threads) {
  auto run = std::make_shared<FitRun>();
  run->kind = kind;
  run->campaign = std::move(campaign);
  run->records = datasets::load_records(*run->campaign, {Use::fit, Use::validate}, threads, true);
  return run;
}

void watch(const JobTerms& terms, calib::FitOptions& settings, const std::string& work) {
  if (terms.watch) terms.watch(settings, work);
}

JobResult finished(std::shared_ptr<FitRun> run, bool strict) {
  JobResult job;
  const FitStatus status = status_of(run->fit);
  const bool is_fit = run->kind == ResultKind::fit;
  job.first = {is_fit ? "fit.json" : "validation.json", "scorecard.csv", "parameters.csv",
               "residuals/"};
  if (is_fit && status != FitStatus::failed) job.first.emplace_back("fitted.toml");
  job.inputs = run->provenance.inputs;
  job.code = code_of(status, run->fit.verdict, strict);
  job.fit = std::move(run);
  return job;
}

/// Runs the fit in a process that is not the leader. This process works on the leader's tasks and
/// obtains the same results.
void help(const FitRun& run, const Provenance& searched, bool resume, const JobTerms& terms,
          calib::FitOptions settings) {
  settings.farm = terms.processes;
  const auto earlier = resume ? CheckpointFile(terms.out, searched).read() : std::nullopt;
  if (earlier) settings.resume = &*earlier;
  calib::fit(*run.campaign, run.records, settings);
}

/// Runs the fit and stores what is needed to resume it.
void search(FitRun& run, Unfinished& kept, bool resume, const JobTerms& terms,
            calib::FitOptions settings) {
  settings.farm = &kept.tasks;
  const auto earlier = resume ? kept.checkpoint.read() : std::nullopt;
  if (earlier) settings.resume = &*earlier;
  // If --resume finds nothing to resume, the user must know that the fit starts from the beginning.
  if (resume && !earlier && kept.tasks.found() == 0 && terms.note)
    terms.note(fmt::format("no checkpoint in {}{}: the fit starts from the beginning",
                           terms.out.string(),
                           settings.starts > 1 ? "" : " (a fit with one start writes none)"));
  if (settings.starts > 1)
    settings.checkpoint = [&](const calib::Checkpoint& reached) { kept.checkpoint.keep(reached); };
  give_freed_memory_back();  // frees the memory of the single repeats
  run.fit = calib::fit(*run.campaign, run.records, settings);
  // The deviations are dropped here. The files and the page do not need them, and creating the
  // files takes as much memory again.
  datasets::drop_deviations(run.records);
  give_freed_memory_back();
  give_large_blocks_back();
}

/// Returns true if two results come from the same version, inputs, seed and options. Input paths
/// may differ, for example because the folder was moved.
bool same_making(const StoredProvenance& a, const StoredProvenance& b) {
  return a.version == b.version && a.revision == b.revision && a.seed == b.seed &&
         a.options == b.options &&
         std::equal(a.inputs.begin(), a.inputs.end(), b.inputs.begin(), b.inputs.end(),
                    [](const auto& x, const auto& y) { return x.sha256 == y.sha256; });
}

bool files_stand(const std::filesystem::path& folder, const StoredProvenance& provenance) {
  return provenance.files &&
         std::all_of(provenance.files->begin(), provenance.files->end(), [&](const auto& file) {
           return sha256_of_file(folder / file.path) == file.sha256;
         });
}

/// Returns the fit in a folder if it is complete and a new run would give the same result. It must
/// not have been stopped. Version, inputs, seed and options must be the same, and every listed file
/// must be present and unchanged.
std::optional<StoredFit> whole_fit(const std::filesystem::path& folder,
                                   const Provenance& provenance) {
  const std::filesystem::path file = folder / "fit.json";
  if (!std::filesystem::exists(file)) return std::nullopt;
  try {
    const auto fit = load<StoredFit>(files_in(folder), folder.string(), "fit.json");
    const bool ended = fit.status != calib::FitStatus::stopped;
    if (ended && same_making(fit.provenance, stored(provenance)) &&
        files_stand(folder, fit.provenance))
      return fit;
  } catch (const InputError&) {
    // The fit is repeated if its results cannot be read.
  }
  return std::nullopt;
}

}  // namespace

JobResult fit_job(std::shared_ptr<const datasets::Campaign> campaign, const FitRequest& request,
                  const JobTerms& terms) {
  auto run = begun(std::move(campaign), ResultKind::fit, terms.threads);
  calib::FitOptions settings = fit_options(*run->campaign, terms.threads, terms.cancel);
  apply(request.choices, settings);
  const Provenance searched = provenance_of_starts(terms.command, terms.options, request.choices,
                                                   settings, *run->campaign, run->records);
  run->provenance = searched;
  for (const auto& option : recorded(request.choices)) run->provenance.options.push_back(option);
  if (!terms.leads()) {
    help(*run, searched, request.resume, terms, settings);
    return {};
  }
  PlannedFiles planned = planned_result(ResultKind::fit, *run->campaign);
  planned.files.emplace_back(kKeptTasksFile);
  // With `resume` the checkpoint is read instead, and a checkpoint from another fit is rejected
  // with the reason.
  if (!request.resume) planned.files.emplace_back(kCheckpointFile);
  if (request.if_changed) {
    if (const auto made = whole_fit(terms.out, run->provenance)) {
      JobResult job;
      job.files = {{"fit.json", json_text(json_of(*made))}};
      job.code = code_of(made->status, made->verdict, request.strict);
      job.unchanged = true;
      return job;
    }
  }
  terms.hold(std::move(planned));
  watch(terms, settings,
        settings.starts > 1 ? fmt::format("start {{}} of {}", settings.starts)
                            : std::string("start {}"));
  settings.shares = [threads = terms.threads](const calib::Problem& problem,
                                              const std::vector<std::vector<double>>& draws,
                                              const calib::Budget& left) {
    return diagnosis::drawn_shares(problem, draws, threads, left);
  };
  if (terms.out.empty()) {
    run->fit = calib::fit(*run->campaign, run->records, settings);
    return finished(std::move(run), request.strict);
  }
  const auto kept =
      std::make_shared<Unfinished>(terms.out, searched, terms.processes, request.resume);
  search(*run, *kept, request.resume, terms, settings);
  JobResult job = finished(std::move(run), request.strict);
  job.written = [kept, status = job.fit->fit.status] {
    kept->checkpoint.finish(status);
    if (status != FitStatus::stopped) kept->tasks.remove();
  };
  return job;
}

JobResult validation_job(std::shared_ptr<const datasets::Campaign> campaign,
                         const ValidationRequest& request, const JobTerms& terms) {
  std::optional<EarlierFit> earlier;
  if (request.fit.given()) earlier = request.fit.read(campaign->rig.plant);
  auto run = begun(std::move(campaign), ResultKind::validation, terms.threads);
  calib::FitOptions settings = fit_options(*run->campaign, terms.threads, terms.cancel);
  run->provenance = {terms.command, settings.seed, terms.options,
                     hash_inputs(*run->campaign, run->records, request.fit.inputs())};
  terms.hold(planned_result(ResultKind::validation, *run->campaign));
  watch(terms, settings, "nuisance parameters");
  run->fit = validate(*run->campaign, run->records, earlier ? &*earlier : nullptr, run->provenance,
                      settings);
  return finished(std::move(run), request.strict);
}

}  // namespace rigcal::report
