#include "calib/fit.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <utility>

#include "apps/rigcal/checkpoint_file.hpp"
#include "apps/rigcal/fit_choices.hpp"
#include "apps/rigcal/interrupt.hpp"
#include "apps/rigcal/options.hpp"
#include "apps/rigcal/outcome.hpp"
#include "apps/rigcal/progress.hpp"
#include "apps/rigcal/verb.hpp"
#include "common/memory.hpp"
#include "common/printable.hpp"
#include "datasets/prepare/load_record.hpp"
#include "report/run/write_result.hpp"
#include "report/store/checkpoint.hpp"
#include "report/store/folder.hpp"
#include "report/store/kept_tasks.hpp"
#include "report/store/whole_fit.hpp"

namespace rigcal::app {
namespace {

struct FitRequest {
  CampaignOptions common;
  FitChoices choices;
  bool resume = false;
  bool if_changed = false;
};

/// A fit that begins anew must not look as if it went on.
void say_nothing_to_resume(const FitRequest& options, int starts) {
  say(fmt::format("no checkpoint in {}{}: the fit begins anew\n", options.common.out.string(),
                  starts > 1 ? "" : " (a fit of one start keeps none)"));
}

/// Exit code of the result that is there already, if it is the one that would be made.
std::optional<ExitCode> made_before(const FitRequest& options,
                                    const report::Provenance& provenance) {
  const auto result = report::whole_fit(options.common.out, provenance);
  if (!result) return std::nullopt;
  const std::string file = (options.common.out / "fit.json").string();
  print(options.common.print, fmt::format("unchanged: {}\n", file), report::json_of(*result));
  return exit_code_of(result->status, result->verdict, options.choices.strict);
}

/// The same fit in a process that does not lead: it works on the leader's tasks, and continues with
/// the same results.
void help(const datasets::Campaign& campaign, const std::vector<datasets::Record>& records,
          const FitRequest& options, const report::Provenance& searched, TaskFarm& processes,
          calib::FitOptions settings) {
  settings.farm = &processes;
  const auto earlier =
      options.resume ? CheckpointFile(options.common.out, searched).read() : std::nullopt;
  if (earlier) settings.resume = &*earlier;
  calib::fit(campaign, records, settings);
}

ExitCode run_fit(const FitRequest& options, const Invocation& invocation) {
  const datasets::Campaign campaign = load(options.common);
  auto records = datasets::load_records(campaign, {datasets::Use::fit, datasets::Use::validate},
                                        options.common.threads, true);
  calib::FitOptions settings =
      report::fit_options(campaign, options.common.threads, invocation.cancel);
  apply(options.choices, settings);
  const report::Provenance searched = report::provenance_of_starts(
      invocation.command, options.common, options.choices, settings, campaign, records);
  report::Provenance provenance = searched;
  for (const auto& option : recorded(options.choices)) provenance.options.push_back(option);
  const Kept kept;
  if (!invocation.leads()) {
    help(campaign, records, options, searched, *invocation.processes, settings);
    return ExitCode::done;
  }
  report::HeldFolder held(options.common.out,
                          holding("fit", options.common.force, options.common.print));
  if (options.if_changed) {
    if (const auto code = made_before(options, provenance)) return *code;
  }
  report::PlannedFiles planned = report::planned_result(report::ResultKind::fit, campaign);
  planned.files.emplace_back(report::kKeptTasksFile);
  // With --resume the checkpoint is read, and a foreign one is refused with the reason.
  if (!options.resume) planned.files.emplace_back(report::kCheckpointFile);
  held.plan(std::move(planned));

  // Bootstrap, profiles and cross-validation do not change the starts.
  CheckpointFile checkpoint(options.common.out, searched);
  ThreadFarm threads;
  report::KeptTasks tasks(invocation.processes != nullptr ? *invocation.processes : threads,
                          options.common.out / report::kKeptTasksFile, searched, options.resume);
  settings.farm = &tasks;
  const auto earlier = options.resume ? checkpoint.read() : std::nullopt;
  if (earlier) settings.resume = &*earlier;
  if (options.resume && !earlier && tasks.found() == 0 && !options.common.print.quiet)
    say_nothing_to_resume(options, settings.starts);
  if (settings.starts > 1)
    settings.checkpoint = [&](const calib::Checkpoint& reached) { checkpoint.keep(reached); };

  give_freed_memory_back();  // memory of the single repeats
  calib::Fit fit;
  {
    FitProgress progress(options.common.print.quiet,
                         settings.starts > 1 ? fmt::format("start {{}} of {}", settings.starts)
                                             : std::string("start {}"),
                         settings);
    settings.progress = std::ref(progress);
    BesideProgress beside(options.common.print.quiet);
    settings.beside = std::ref(beside);
    fit = calib::fit(campaign, records, settings);
  }
  // Files and page are not made from them, and need as much memory again.
  datasets::drop_deviations(records);
  give_freed_memory_back();
  give_large_blocks_back();
  const ExitCode code = write_and_print(
      held, options.common, {report::ResultKind::fit, campaign, records, fit, provenance},
      options.choices.strict);
  checkpoint.finish(fit.status);
  if (fit.status != calib::FitStatus::stopped) tasks.remove();
  return code;
}

}  // namespace

Run add_fit(CLI::App& verb) {
  const auto options = std::make_shared<FitRequest>();
  add_campaign_options(verb, options->common);
  add_fit_choices(verb, options->choices);
  verb.add_flag("--resume", options->resume,
                "Go on where a fit of the same inputs and options was stopped or killed");
  verb.add_flag("--if-changed", options->if_changed,
                "Do nothing where --out holds the whole result of the same inputs and options");
  return [options](const Invocation& invocation) { return run_fit(*options, invocation); };
}

}  // namespace rigcal::app
