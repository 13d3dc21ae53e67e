#include "apps/rigcal/outcome.hpp"

#include "report/run/write_result.hpp"
#include "report/store/json_fields.hpp"
#include "report/text/terminal.hpp"

namespace rigcal::app {
namespace {

using calib::FitStatus;

std::string text_of(const CampaignOptions& options, const report::Result& result,
                    const std::vector<report::ResultFile>& files) {
  std::vector<std::string> paths;
  for (auto file = files.rbegin(); file != files.rend(); ++file)  // the page and the result first
    if (!file->path.has_parent_path()) paths.push_back((options.out / file->path).string());
  paths.push_back((options.out / "residuals" / "").string());
  return report::result_text(result, paths, terminal_style());
}

}  // namespace

ExitCode exit_code_of(const calib::Fit& fit, bool strict) {
  switch (report::status_of(fit)) {
    case FitStatus::failed:
      return ExitCode::no_result;
    case FitStatus::stopped:
      return ExitCode::stopped;
    case FitStatus::converged:
      break;
  }
  const bool failed =
      fit.verdict == calib::Verdict::fail || (strict && fit.verdict == calib::Verdict::warn);
  return failed ? ExitCode::verdict_fail : ExitCode::done;
}

ExitCode exit_code_of(const report::Json& result, bool strict) {
  const std::string status = report::text_of(result, "status");
  if (status == "failed") return ExitCode::no_result;
  if (status != "converged") return ExitCode::stopped;
  const std::string verdict = report::text_of(result, "verdict");
  const bool failed = verdict == "FAIL" || (strict && verdict == "WARN");
  return failed ? ExitCode::verdict_fail : ExitCode::done;
}

void add_strict_option(CLI::App& verb, bool& strict) {
  verb.add_flag("--strict", strict, "Exit with 1 on WARN too, not only on FAIL");
}

ExitCode write_and_print(const CampaignOptions& options, const report::Result& result,
                         bool strict) {
  report::Json json = report::result_json(result);
  const auto files = report::write_result(options.out, options.threads, result, json);
  print(options.print, text_of(options, result, files), json);
  return exit_code_of(result.fit, strict);
}

}  // namespace rigcal::app
