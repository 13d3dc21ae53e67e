#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "report/batch/batch.hpp"
#include "report/comparison/comparison_parts.hpp"

namespace rigcal::report {
namespace {

constexpr std::size_t kWorstScores = 3;

std::vector<StoredRigScore> worst_scores(const StoredFit& fit) {
  std::vector<std::pair<calib::Badness, StoredRigScore>> scores;
  for (const calib::ConditionResult& condition : fit.conditions) {
    StoredRigScore score;
    score.condition = condition.id;
    score.use = condition.use;
    score.failure = condition.failure.value_or("");
    if (condition.failure) {
      score.verdict = condition.verdict;
      scores.emplace_back(badness(condition), score);
      continue;
    }
    for (const calib::ChannelScore& channel : condition.channels) {
      score.channel = channel.key();
      score.verdict = condition.verdict_of(channel.channel);
      score.rho2 = finite(channel.metrics.rho2);
      score.absolute_error_percent = finite(channel.metrics.absolute_error_percent);
      scores.emplace_back(badness(condition, channel.key()), score);
    }
  }
  std::stable_sort(scores.begin(), scores.end(),
                   [](const auto& a, const auto& b) { return b.first < a.first; });
  std::vector<StoredRigScore> worst;
  for (std::size_t i = 0; i < std::min(scores.size(), kWorstScores); ++i)
    worst.push_back(std::move(scores[i].second));
  return worst;
}

/// Lists the reasons that keep each aspect from passing.
std::vector<std::string> reasons_of(const StoredFit& fit) {
  std::vector<std::string> reasons;
  if (!fit.assessment) return reasons;
  calib::Assessment::describe(*fit.assessment, [&](const char* name, const calib::Aspect& aspect) {
    for (const calib::Reason& reason : aspect.reasons) {
      if (calib::is_against(reason.state))
        reasons.push_back(fmt::format("{}: {}", name, reason.words));
    }
  });
  return reasons;
}

/// Returns true for parameters that can be compared between rigs and dates: all fitted ones except
/// nuisance parameters.
bool is_shown(const calib::FittedParameter& parameter) {
  return parameter.fitted && !parameter.nuisance;
}

std::vector<StoredRigEstimate> estimates(const StoredFit& fit) {
  std::vector<StoredRigEstimate> list;
  for (const calib::FittedParameter& p : fit.parameters) {
    if (!is_shown(p)) continue;
    list.push_back(
        {p.key, p.name, p.unit, p.scope, p.level, p.value, finite_ends(p.ci95), p.identifiability});
  }
  return list;
}

/// Computes the trend of every estimate that occurs in at least two results.
std::vector<StoredRigTrend> trends_of(const RigRun& run) {
  std::vector<Compared> results = run.earlier;
  results.push_back(*run.result);
  std::vector<StoredRigTrend> list;
  std::set<std::string> seen;
  for (const calib::FittedParameter& parameter : run.result->result.parameters) {
    if (!is_shown(parameter) || !seen.insert(parameter.key).second) continue;
    for (StoredSeries& series : trends(results, parameter.key)) {
      if (series.points.size() >= 2)
        list.push_back({parameter.key, parameter.unit, std::move(series)});
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
  const StoredFit& fit = run.result->result;
  row.name = fit.campaign;
  row.status = fit.status;
  row.verdict = fit.verdict;
  if (row.message.empty()) row.message = fit.message;
  row.synthetic = fit.synthetic;
  row.has_report = true;
  row.reasons = reasons_of(fit);
  row.worst_scores = worst_scores(fit);
  row.parameters = estimates(fit);
  row.warnings = fit.warnings;
  row.warnings.insert(row.warnings.end(), run.unread.begin(), run.unread.end());
  row.trends = trends_of(run);
  return row;
}

}  // namespace rigcal::report
