#include "apps/rigcal/outcome.hpp"

#include <fmt/format.h>

#include <functional>
#include <memory>

#include "apps/rigcal/result_page.hpp"
#include "common/file.hpp"
#include "report/store/csv.hpp"
#include "report/store/folder.hpp"
#include "report/store/json.hpp"
#include "report/store/parameters_csv.hpp"
#include "report/store/result_files.hpp"
#include "report/store/stored_fit.hpp"
#include "report/text/terminal.hpp"

namespace rigcal::app {
namespace {

using calib::FitStatus;

std::string fitted_toml(const CampaignOptions& options, const report::Result& result) {
  std::vector<datasets::FittedValue> values;
  for (const calib::FittedParameter& p : result.fit.parameters) {
    if (p.fitted) values.push_back({p.index, p.scope, p.level, p.value});
  }
  const std::string text = fitted_campaign_text(result.campaign, values, options.out);
  if (result.fit.has_converged()) return text;
  return "# status: stopped: the best so far, not a fit that converged\n" + text;
}

std::filesystem::path residual_file(const std::string& condition) {
  return std::filesystem::path("residuals") / (condition + ".csv");
}

/// Scores whose residuals are written. A fit that failed early scored nothing; its files say so all
/// the same.
std::vector<calib::ConditionScore> unscored(const report::Result& result) {
  std::vector<calib::ConditionScore> scores;
  for (const datasets::Condition& condition : result.campaign.conditions) {
    const bool taken =
        condition.use == datasets::Use::fit || condition.use == datasets::Use::validate;
    if (!taken || !result.fit.conditions.empty()) continue;
    scores.emplace_back().id = condition.id;
  }
  return scores;
}

/// Before anything is made.
/// @throws UsageError  one of the files would replace an input
void require_inputs_kept(const CampaignOptions& options, const report::Result& result) {
  std::vector<std::filesystem::path> files{
      "scorecard.csv",
      "parameters.csv",
      "residual_tests.json",
      "fitted.toml",
      "report.html",
      result.kind == report::ResultKind::fit ? "fit.json" : "validation.json"};
  for (const datasets::Condition& condition : result.campaign.conditions)
    files.push_back(residual_file(condition.id));
  report::require_inputs_kept(options.out, files, result.provenance.inputs);
}

/// Every file but the residuals.
/// @param residuals  their names, which the result gives with those of the other files
/// @param stored     the result, to which they are added
std::vector<report::ResultFile> files_of(const CampaignOptions& options,
                                         const report::Result& result,
                                         const std::vector<report::InputFile>& residuals,
                                         report::StoredFit& stored) {
  const bool is_fit = result.kind == report::ResultKind::fit;
  std::vector<report::ResultFile> files;
  files.push_back({"scorecard.csv", report::scorecard_csv(result)});
  files.push_back(
      {"parameters.csv", report::parameters_csv(stored.status, stored.message, stored.parameters)});
  files.push_back(
      {"residual_tests.json", report::json_line(report::json_of(report::stored_curves(result)))});
  if (is_fit && report::status_of(result.fit) != FitStatus::failed) {
    files.push_back({"fitted.toml", fitted_toml(options, result)});
  }
  report::name_files(residuals, files, stored.provenance);
  // Last, so that whoever finds it finds the others too.
  files.push_back(
      {is_fit ? "fit.json" : "validation.json", report::json_text(report::json_of(stored))});
  add_page(options.out, options.threads, files, [&result](const std::filesystem::path& path) {
    for (const calib::ConditionScore& score : result.fit.conditions)
      if (residual_file(score.id) == path)
        return std::make_shared<const report::Table>(report::residual_table(result, score));
    return std::shared_ptr<const report::Table>();
  });
  return files;
}

std::string text_of(const CampaignOptions& options, const report::Result& result,
                    const std::vector<report::ResultFile>& files) {
  const report::Style style = terminal_style();
  std::vector<std::string> paths;
  for (auto file = files.rbegin(); file != files.rend(); ++file)  // the page and the result first
    if (!file->path.has_parent_path()) paths.push_back((options.out / file->path).string());
  paths.push_back((options.out / "residuals" / "").string());
  return report::summary_text(result, paths, style) + "\n" +
         report::parameters_text(result, style) + "\n" + report::scorecard_text(result, style) +
         "\n" + report::reasons_text(result, style);
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

ExitCode write_and_print(const CampaignOptions& options, const report::Result& result,
                         bool strict) {
  report::StoredFit stored = report::stored(result);
  const ExitCode code = exit_code_of(stored.status, stored.verdict, strict);
  const std::vector<calib::ConditionScore> early = unscored(result);
  require_inputs_kept(options, result);
  report::ResultsInWriting writing(options.out, result.provenance.inputs);
  std::vector<report::InputFile> residuals;
  for (const auto& scores : {std::cref(result.fit.conditions), std::cref(early)}) {
    for (const calib::ConditionScore& score : scores.get()) {
      const std::string text = report::residuals_csv(result, score);
      residuals.push_back({residual_file(score.id).generic_string(), sha256_of_text(text)});
      writing.add(residual_file(score.id), text);
    }
  }
  const std::vector<report::ResultFile> files = files_of(options, result, residuals, stored);
  for (const report::ResultFile& file : files) writing.add(file.path, file.content);
  writing.move_into_place();
  if (result.kind == report::ResultKind::fit && code == ExitCode::no_result) {
    report::remove_stale(options.out / "fitted.toml");
  }
  print(options.print, text_of(options, result, files), report::json_of(stored));
  return code;
}

calib::FitOptions fit_options(const CampaignOptions& options, const datasets::Campaign& campaign,
                              const std::atomic<bool>& cancel) {
  calib::FitOptions fit;
  fit.starts = campaign.fit.starts;
  fit.max_iterations = campaign.fit.max_iterations;
  fit.max_seconds = campaign.fit.max_seconds;
  fit.threads = options.threads;
  fit.cancel = &cancel;
  return fit;
}

}  // namespace rigcal::app
