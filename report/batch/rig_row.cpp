#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "report/batch/batch.hpp"
#include "report/comparison/comparison_parts.hpp"

namespace rigcal::report {
namespace {

constexpr std::size_t kWorstScores = 3;

std::optional<std::string> known_text(const Json& json, const std::string& key) {
  std::string text = text_of(json, key);
  return text.empty() ? std::nullopt : std::optional(std::move(text));
}

/// What could not be simulated first, then by verdict, then by the lowest rho2.
std::pair<int, double> badness(const StoredRigScore& score) {
  const int rank = !score.failure.empty()    ? 0
                   : score.verdict == "FAIL" ? 1
                   : score.verdict == "WARN" ? 2
                                             : 3;
  return {rank, score.rho2.value_or(-1.0)};
}

std::vector<StoredRigScore> worst_scores(const Json& result) {
  std::vector<StoredRigScore> scores;
  for (const Json& condition : result.at("conditions")) {
    StoredRigScore score;
    score.condition = text_of(condition, "id");
    score.use = text_of(condition, "use");
    score.failure = text_of(condition, "failure");
    if (!score.failure.empty()) {
      score.verdict = known_text(condition, "verdict");
      scores.push_back(score);
      continue;
    }
    for (const auto& [channel, metrics] : condition.at("metrics").items()) {
      score.channel = channel;
      const Json verdict = channel_verdict(condition, channel);
      score.verdict =
          verdict.is_string() ? std::optional(verdict.get<std::string>()) : std::nullopt;
      score.rho2 = number_of(metrics, "rho2");
      score.absolute_error_percent = number_of(metrics, "absolute_error_percent");
      scores.push_back(score);
    }
  }
  std::stable_sort(scores.begin(), scores.end(),
                   [](const auto& a, const auto& b) { return badness(a) < badness(b); });
  scores.resize(std::min(scores.size(), kWorstScores));
  return scores;
}

/// Of each aspect that is no pass.
std::vector<std::string> reasons_of(const Json& result) {
  std::vector<std::string> reasons;
  for (const auto& [aspect, judged] : result.at("assessment").items()) {
    for (const Json& reason : judged.at("reasons")) {
      if (text_of(reason, "state") != "pass")
        reasons.push_back(fmt::format("{}: {}", aspect, text_of(reason, "words")));
    }
  }
  return reasons;
}

/// What a reader follows from one rig and day to another: no nuisance parameters.
bool is_shown(const Json& parameter) {
  return parameter.at("fitted").get<bool>() && !parameter.at("nuisance").get<bool>();
}

std::vector<StoredRigEstimate> estimates(const Json& result) {
  std::vector<StoredRigEstimate> list;
  for (const Json& parameter : result.at("parameters")) {
    if (!is_shown(parameter)) continue;
    StoredRigEstimate each;
    each.key = text_of(parameter, "key");
    each.name = text_of(parameter, "name");
    each.unit = text_of(parameter, "unit");
    each.scope = text_of(parameter, "scope");
    each.level = known_text(parameter, "level");
    each.value = number_of(parameter, "value").value_or(std::nan(""));
    const Json& ends = parameter.at("ci95");
    if (ends.is_array() && ends.size() == 2 && ends[0].is_number() && ends[1].is_number())
      each.ci95 = Range{ends[0].get<double>(), ends[1].get<double>()};
    each.identifiability = known_text(parameter, "identifiability");
    list.push_back(std::move(each));
  }
  return list;
}

/// Of every estimate that two results or more have.
std::vector<StoredRigTrend> trends_of(const RigRun& run) {
  std::vector<Compared> results = run.earlier;
  results.push_back(*run.result);
  std::vector<StoredRigTrend> list;
  std::set<std::string> seen;
  for (const Json& parameter : run.result->result.at("parameters")) {
    const std::string key = text_of(parameter, "key");
    if (!is_shown(parameter) || !seen.insert(key).second) continue;
    for (Json& series : trends(results, key)) {
      if (series.at("points").size() < 2) continue;
      list.push_back({key, text_of(parameter, "unit"), std::move(series)});
    }
  }
  return list;
}

}  // namespace

StoredRig rig_row(const RigRun& run) {
  StoredRig row;
  row.rig = run.rig;
  row.campaign = run.campaign.string();
  row.folder = run.folder;
  row.exit_code = static_cast<int>(run.code);
  row.unchanged = run.unchanged;
  row.seconds = run.seconds;
  row.message = run.error;
  if (!run.result) return row;
  const StoredRig without = row;
  try {
    const Json& result = run.result->result;
    row.name = known_text(result, "campaign");
    row.status = known_text(result, "status");
    row.verdict = known_text(result, "verdict");
    if (row.message.empty()) row.message = text_of(result, "message");
    row.synthetic = result.at("synthetic").get<bool>();
    row.has_report = true;
    row.reasons = reasons_of(result);
    row.worst_scores = worst_scores(result);
    row.parameters = estimates(result);
    row.warnings = result.at("warnings").get<std::vector<std::string>>();
    row.warnings.insert(row.warnings.end(), run.unread.begin(), run.unread.end());
    row.trends = trends_of(run);
    return row;
  } catch (const Json::exception& error) {
    row = without;
    row.message = fmt::format("the result is not as this version writes it: {}", error.what());
    row.exit_code = static_cast<int>(ExitCode::internal);
    return row;
  }
}

}  // namespace rigcal::report
