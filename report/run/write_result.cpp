#include "report/run/write_result.hpp"

#include <fmt/format.h>

#include <functional>
#include <memory>
#include <mutex>

#include "common/file.hpp"
#include "common/parallel.hpp"
#include "report/live/live_fit.hpp"
#include "report/page/page.hpp"
#include "report/run/missing_terms.hpp"
#include "report/store/csv.hpp"
#include "report/store/csv_fields.hpp"
#include "report/store/json.hpp"
#include "report/store/result_files.hpp"
#include "report/store/table.hpp"

namespace rigcal::report {
namespace {

namespace fs = std::filesystem;
using calib::FitStatus;

constexpr const char* kDrawsFile = "posterior.csv";

/// Writes posterior.csv: one row per draw, with the number of the chain and of the draw in the
/// chain (both from 1), and one column per unknown, in SI.
std::string draws_csv(const calib::Posterior& posterior) {
  const auto draws = static_cast<std::size_t>(posterior.draws);
  const std::size_t rows = static_cast<std::size_t>(posterior.chains) * draws;
  Table table;
  table.add("chain", rows, [&](std::size_t i) { return i / draws + 1; });
  table.add("draw", rows, [&](std::size_t i) { return i % draws + 1; });
  for (std::size_t k = 0; k < posterior.names.size(); ++k)
    table.add(csv_text(posterior.names[k]), posterior.values[k]);
  return csv_of(table);
}

/// Writes the terms that the residuals call for as comments, ready to be used in the next campaign.
std::string terms_in_comments(const Result& result) {
  if (!result.fit.considered) return {};
  std::string text;
  for (const MissingTerm& each : missing_terms(result.campaign.rig.plant, *result.fit.considered)) {
    text += fmt::format("#   [rig.{}] {}\n", each.of_controller ? "controller" : "parameters",
                        each.line);
  }
  if (text.empty()) return {};
  return "# The residuals indicate a term that this model lacks. The next campaign may estimate "
         "it:\n" +
         text;
}

std::string fitted_toml(const fs::path& out, const Result& result) {
  std::vector<datasets::FittedValue> values;
  for (const calib::FittedParameter& p : result.fit.parameters) {
    if (p.fitted) values.push_back({p.index, p.scope, p.level.value_or(""), p.value});
  }
  const std::string text =
      terms_in_comments(result) + fitted_campaign_text(result.campaign, values, out);
  if (result.fit.has_converged()) return text;
  return "# status: stopped: the best so far, not a fit that converged\n" + text;
}

fs::path residual_file(const std::string& condition) {
  return fs::path("residuals") / (condition + ".csv");
}

/// Builds placeholder scores for a fit that failed before it scored anything, so that its residual
/// files also report the failure.
std::vector<calib::ConditionScore> unscored(const Result& result) {
  std::vector<calib::ConditionScore> scores;
  for (const datasets::Condition& condition : result.campaign.conditions) {
    const bool taken =
        condition.use == datasets::Use::fit || condition.use == datasets::Use::validate;
    if (!taken || !result.fit.conditions.empty()) continue;
    scores.emplace_back().id = condition.id;
  }
  return scores;
}

fs::path main_file(ResultKind kind) {
  return kind == ResultKind::fit ? "fit.json" : "validation.json";
}

/// Creates the residual files and passes each one on as soon as its text is ready. Keeping the
/// files of all conditions would be the peak memory use when writing a result.
///
/// @return  names and hashes of the files, in the order of the scores
std::vector<InputFile> add_residuals(const Result& result, int threads,
                                     const std::function<void(ResultFile)>& add) {
  const std::vector<calib::ConditionScore> early = unscored(result);
  const auto& scores = result.fit.conditions.empty() ? early : result.fit.conditions;
  std::vector<InputFile> files(scores.size());
  std::mutex one_at_a_time;
  parallel_for(scores.size(), threads, [&](std::size_t i) {
    const fs::path file = residual_file(scores[i].id);
    std::string text = residuals_csv(result, scores[i]);
    files[i] = {file.generic_string(), sha256_of_text(text)};
    const std::lock_guard lock(one_at_a_time);
    add({file, std::move(text), files[i].sha256});
  });
  return files;
}

/// Returns a reader that makes the table of a residual file on demand.
ReadFile tables_of(const Result& result) {
  return [&result](const fs::path& path) -> std::shared_ptr<const ResultFile> {
    for (const calib::ConditionScore& score : result.fit.conditions)
      if (residual_file(score.id) == path)
        return std::make_shared<const ResultFile>(
            ResultFile{path, {}, {}, std::make_shared<const Table>(residual_table(result, score))});
    return nullptr;
  };
}

ResultFile curves_file(const Result& result) {
  return json_file("residual_tests.json", stored_curves(result), json_line);
}

/// Creates every file except the residuals and the page.
///
/// @param residuals  names of the residual files, listed in the result with the other files
std::vector<ResultFile> files_of(const fs::path& out, const Result& result,
                                 const std::vector<InputFile>& residuals) {
  StoredFit stored = report::stored(result);
  std::vector<ResultFile> files;
  files.push_back({"scorecard.csv", scorecard_csv(result)});
  files.push_back(
      {"parameters.csv", parameters_csv(stored.status, stored.message, stored.parameters)});
  if (const auto& found = result.fit.posterior; found && found->draws > 0)
    files.push_back({kDrawsFile, draws_csv(*found)});
  files.push_back(curves_file(result));
  if (result.kind == ResultKind::fit && stored.status != FitStatus::failed)
    files.push_back({"fitted.toml", fitted_toml(out, result)});
  if (auto live = live_fit(result))
    files.push_back(json_file(kLiveFile, std::move(*live), json_line));
  name_files(files, stored.provenance, residuals);
  // This file is last, so that its presence means that all others exist.
  files.push_back(json_file(main_file(result.kind), std::move(stored)));
  return files;
}

/// Returns the files needed for a page without curves.
std::vector<ResultFile> shown_files(const Result& result) {
  return {curves_file(result), json_file(main_file(result.kind), stored(result))};
}

}  // namespace

PlannedFiles planned_result(ResultKind kind, const datasets::Campaign& campaign) {
  PlannedFiles planned{
      {"scorecard.csv", "parameters.csv", "residual_tests.json", "report.html", main_file(kind)},
      {"residuals"}};
  planned.files.emplace_back(kLiveFile);
  if (kind == ResultKind::fit) {
    planned.files.emplace_back("fitted.toml");
    planned.files.emplace_back(kDrawsFile);
  }
  for (const datasets::Condition& condition : campaign.conditions) {
    if (condition.use == datasets::Use::fit || condition.use == datasets::Use::validate)
      planned.files.push_back(residual_file(condition.id));
  }
  return planned;
}

WrittenResult write_result(HeldFolder& held, int threads, const Result& result) {
  const fs::path& out = held.path();
  const PlannedFiles planned = planned_result(result.kind, result.campaign);
  require_inputs_kept(out, planned.files, result.provenance.inputs);
  held.plan(planned);
  ResultsInWriting writing(held, result.provenance.inputs);
  const std::vector<InputFile> residuals =
      add_residuals(result, threads, [&](const ResultFile& file) { writing.add(file); });
  WrittenResult written;
  for (const InputFile& file : residuals) written.files.emplace_back(file.path);
  std::vector<ResultFile> files = files_of(out, result, residuals);
  written.documents = add_page(out, threads, files, tables_of(result));
  for (const ResultFile& file : files) {
    writing.add(file);
    written.files.push_back(file.path);
  }
  written.json = std::move(files.back().content);
  writing.move_into_place();
  return written;
}

std::vector<ResultFile> result_files(const Result& result, int threads) {
  std::vector<ResultFile> files;
  const std::vector<InputFile> residuals =
      add_residuals(result, threads, [&](ResultFile file) { files.push_back(std::move(file)); });
  for (ResultFile& file : files_of({}, result, residuals)) files.push_back(std::move(file));
  return files;
}

doc::Document document_of(const Result& result) {
  const std::vector<ResultFile> files = shown_files(result);
  return result_documents(either(files_in(files), tables_of(result)), result.campaign.name).front();
}

std::string brief_page(const Result& result) {
  const std::vector<ResultFile> files = shown_files(result);
  return brief_page(either(files_in(files), tables_of(result)), result.campaign.name);
}

}  // namespace rigcal::report
