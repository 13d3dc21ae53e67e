#include "apps/rigcal/outcome.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "apps/rigcal/interrupt.hpp"
#include "apps/rigcal/progress.hpp"
#include "common/printable.hpp"
#include "report/document/render_terminal.hpp"

namespace rigcal::app {

void add_strict_option(CLI::App& verb, bool& strict) {
  verb.add_flag("--strict", strict, "Exit with 1 on WARN too, not only on FAIL");
}

std::shared_ptr<const datasets::Campaign> loaded(const CampaignOptions& options) {
  return std::make_shared<const datasets::Campaign>(load(options));
}

namespace {

ExitCode run_with(report::JobTerms terms, const char* verb, const JobOptions& options,
                  const Invocation& invocation, const Job& job, OnSignal on_signal) {
  std::optional<Kept> kept;
  std::optional<report::HeldFolder> held;
  terms.out = options.out;
  terms.processes = invocation.processes;
  terms.hold = [&](report::PlannedFiles planned) {
    if (on_signal == OnSignal::keep_result) kept.emplace();
    held.emplace(options.out, holding(verb, options.force, options.print));
    held->plan(std::move(planned));
  };
  terms.note = [&](const std::string& text) {
    if (!options.print.quiet) say(text + "\n");
  };
  if (!terms.leads()) {
    kept.emplace();
    return job(terms).code;
  }
  report::JobResult result;
  {
    BesideProgress pieces(options.print.quiet);
    std::optional<FitProgress> searched;
    terms.progress = std::ref(pieces);
    terms.watch = [&](calib::FitOptions& settings, const std::string& work) {
      searched.emplace(options.print.quiet, work, settings);
      settings.progress = std::ref(*searched);
      settings.beside = std::ref(pieces);
    };
    result = job(terms);
  }
  if (result.unchanged) {
    const report::ResultFile& file = result.files.back();
    print(options.print, fmt::format("unchanged: {}\n", (options.out / file.path).string()),
          file.content);
    return result.code;
  }
  const ExitCode code = result.code;
  std::vector<std::string> first = std::move(result.first);
  const std::optional<report::Printed> printed = result.printed;
  if (!printed) first.emplace_back("report.html");
  const auto written = report::write_job(held.value(), options.threads, std::move(result));
  std::string text = printed ? printed->text : std::string();
  for (const report::doc::Document& document : written.documents) {
    if (!text.empty()) text += "\n";
    text += render_terminal(document, terminal_style(options.print));
  }
  text += "files:";
  for (const std::string& file : first) text += " " + (options.out / file).string();
  print(options.print, text + "\n", written.json);
  if (printed && !printed->problems.empty()) throw NoResultError(printed->problems);
  return code;
}

}  // namespace

ExitCode run_job(const char* verb, const CampaignOptions& options, const Invocation& invocation,
                 const Job& job, OnSignal on_signal) {
  return run_with({invocation.command, recorded(options), options.threads, invocation.cancel}, verb,
                  options, invocation, job, on_signal);
}

ExitCode run_job(const char* verb, const JobOptions& options, const Invocation& invocation,
                 const Job& job, OnSignal on_signal) {
  return run_with({invocation.command, {}, options.threads, invocation.cancel}, verb, options,
                  invocation, job, on_signal);
}

}  // namespace rigcal::app
