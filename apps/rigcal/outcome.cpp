#include "apps/rigcal/outcome.hpp"

#include <functional>
#include <utility>

#include "apps/rigcal/progress.hpp"
#include "report/document/render_terminal.hpp"
#include "report/live/live_fit.hpp"
#include "report/run/result_page.hpp"
#include "report/run/write_result.hpp"
#include "report/store/json.hpp"
#include "report/store/stored/stored_fit.hpp"
#include "report/text/terminal.hpp"

namespace rigcal::app {
namespace {

using calib::FitStatus;

std::string text_of(const CampaignOptions& options, const report::Result& result,
                    const std::vector<std::filesystem::path>& files) {
  std::vector<std::string> paths;
  for (auto file = files.rbegin(); file != files.rend(); ++file)  // the page and the result first
    if (!file->has_parent_path() && *file != report::kLiveFile)
      paths.push_back((options.out / *file).string());
  paths.push_back((options.out / "residuals" / "").string());
  return report::result_text(result, paths, terminal_style(options.print));
}

}  // namespace

ExitCode exit_code_of(FitStatus status, std::optional<calib::Verdict> verdict, bool strict) {
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

void add_strict_option(CLI::App& verb, bool& strict) {
  verb.add_flag("--strict", strict, "Exit with 1 on WARN too, not only on FAIL");
}

ExitCode write_and_print(report::HeldFolder& held, const CampaignOptions& options,
                         const report::Result& result, bool strict) {
  report::StoredFit stored = report::stored(result);
  const auto files = report::write_result(held, options.threads, result, stored);
  print(options.print, text_of(options, result, files), report::json_of(stored));
  return exit_code_of(stored.status, stored.verdict, strict);
}

namespace {

ExitCode run_with(report::JobTerms terms, const char* verb, const JobOptions& options,
                  const std::function<report::JobResult(const report::JobTerms&)>& job) {
  std::optional<report::HeldFolder> held;
  terms.hold = [&](report::PlannedFiles planned) {
    held.emplace(options.out, holding(verb, options.force, options.print));
    held->plan(std::move(planned));
  };
  report::JobResult result;
  {
    BesideProgress progress(options.print.quiet);
    terms.progress = std::ref(progress);
    result = job(terms);
  }
  add_page(options.out, options.threads, result.files);
  report::write_results(held.value(), result.files, result.inputs);
  result.first.emplace_back("report.html");
  print(options.print, {result.verdict, result.sections, result.synthetic}, options.out,
        result.first, result.json);
  return result.code;
}

}  // namespace

ExitCode run_job(const char* verb, const CampaignOptions& options, const Invocation& invocation,
                 const std::function<report::JobResult(const report::JobTerms&)>& job) {
  return run_with({invocation.command, recorded(options), options.threads, invocation.cancel}, verb,
                  options, job);
}

ExitCode run_job(const char* verb, const JobOptions& options, const Invocation& invocation,
                 const std::function<report::JobResult(const report::JobTerms&)>& job) {
  return run_with({invocation.command, {}, options.threads, invocation.cancel}, verb, options, job);
}

std::string text_of(const PrintedDocument& document, const PrintOptions& options) {
  std::string text =
      report::doc::render_terminal(document.verdict, document.sections, terminal_style(options));
  if (document.synthetic) text += "note: the records of this campaign are synthetic\n";
  return text;
}

void print(const PrintOptions& options, const PrintedDocument& document,
           const std::filesystem::path& folder, const std::vector<std::string>& files,
           const report::Json& json) {
  std::string text = text_of(document, options) + "files:";
  for (const std::string& file : files) text += " " + (folder / file).string();
  print(options, text + "\n", json);
}

}  // namespace rigcal::app
