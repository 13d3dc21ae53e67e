#include "report/run/write_result.hpp"

#include "report/run/result_page.hpp"
#include "report/store/csv.hpp"
#include "report/store/parameters_csv.hpp"
#include "report/store/residual_tests_json.hpp"
#include "report/store/result_files.hpp"

namespace rigcal::report {
namespace {

namespace fs = std::filesystem;
using calib::FitStatus;

std::string fitted_toml(const fs::path& out, const Result& result) {
  std::vector<datasets::FittedValue> values;
  for (const calib::FittedParameter& p : result.fit.parameters) {
    if (p.fitted) values.push_back({p.index, p.scope, p.level, p.value});
  }
  const std::string text = fitted_campaign_text(result.campaign, values, out);
  if (result.fit.has_converged()) return text;
  return "# status: stopped: the best so far, not a fit that converged\n" + text;
}

/// @param json  the result, to which the names of its files are added
std::vector<ResultFile> files_of(const fs::path& out, int threads, const Result& result,
                                 Json& json) {
  const bool is_fit = result.kind == ResultKind::fit;
  std::vector<ResultFile> files;
  for (const calib::ConditionScore& score : result.fit.conditions) {
    files.push_back({fs::path("residuals") / (score.id + ".csv"), residuals_csv(result, score)});
  }
  // A fit that failed early scored nothing; its files say so all the same.
  for (const datasets::Condition& condition : result.campaign.conditions) {
    const bool taken =
        condition.use == datasets::Use::fit || condition.use == datasets::Use::validate;
    if (!taken || !result.fit.conditions.empty()) continue;
    calib::ConditionScore score;
    score.id = condition.id;
    files.push_back(
        {fs::path("residuals") / (condition.id + ".csv"), residuals_csv(result, score)});
  }
  files.push_back({"scorecard.csv", scorecard_csv(result)});
  files.push_back({"parameters.csv", parameters_csv(json)});
  files.push_back({"residual_tests.json", residual_curves_text(result)});
  if (is_fit && status_of(result.fit) != FitStatus::failed) {
    files.push_back({"fitted.toml", fitted_toml(out, result)});
  }
  name_files(files, json);
  // Last, so that whoever finds it finds the others too.
  files.push_back({is_fit ? "fit.json" : "validation.json", json_text(json)});
  add_page(out, threads, files);
  return files;
}

}  // namespace

std::vector<ResultFile> write_result(const fs::path& out, int threads, const Result& result,
                                     Json& json) {
  std::vector<ResultFile> files = files_of(out, threads, result, json);
  write_results(out, files, result.provenance.inputs);
  if (result.kind == ResultKind::fit && status_of(result.fit) == FitStatus::failed)
    remove_stale(out / "fitted.toml");
  return files;
}

}  // namespace rigcal::report
